#include "filter_volmorph/vdb_contents.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <fstream>

namespace meshcomplete {
namespace {

constexpr std::uint64_t vdb_magic = 0x56444220;
constexpr std::uint32_t oldest_version = 222;
constexpr std::streamoff uuid_length = 36;
constexpr std::uint32_t longest_name = 4096;  ///< bytes; names of metadata, grids and types
constexpr std::size_t most_names = 10000;

/// Thrown where the file does not go on as a .vdb does.
struct Unreadable {};

void demand(bool condition) {
  if (!condition) throw Unreadable();
}

/// Reads the numbers of the file format: lowest byte first.
class HeadReader {
 public:
  explicit HeadReader(const std::string& path) : file_(path, std::ios::binary) {
    file_.seekg(0, std::ios::end);
    demand(static_cast<bool>(file_));
    length_ = file_.tellg();
    file_.seekg(0);
  }

  std::uint64_t number(int bytes) {
    std::uint64_t number = 0;
    for (int i = 0; i < bytes; ++i) {
      const int byte = file_.get();
      demand(byte >= 0);
      number |= std::uint64_t(byte) << (8 * i);
    }
    return number;
  }

  std::string name() {
    const auto length = static_cast<std::uint32_t>(number(4));
    demand(length <= longest_name);
    std::string name(length, ' ');
    file_.read(name.data(), length);
    demand(static_cast<bool>(file_));
    return name;
  }

  void skip(std::streamoff bytes) { go_to(file_.tellg() + bytes); }
  void go_to(std::streamoff place) {
    demand(place <= length_);
    file_.seekg(place);
    demand(static_cast<bool>(file_));
  }
  std::streamoff place() { return file_.tellg(); }

 private:
  std::ifstream file_;
  std::streamoff length_ = 0;
};

/// A grid's name as a user knows it: OpenVDB tells grids of the same name apart by what follows the character
/// 30.
std::string readable(const std::string& name) {
  std::string text = name.substr(0, name.find('\x1e'));
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return std::iscntrl(c) != 0; }, '?');
  return text;
}

void read_grids(HeadReader& file, VdbContents& contents) {
  const std::uint64_t count = file.number(4);
  for (std::uint64_t i = 0; i < std::min<std::uint64_t>(count, most_names); ++i) {
    const std::string name = file.name();
    file.name();  // the type
    file.name();  // the grid whose tree it shares
    file.skip(16);
    const std::uint64_t end = file.number(8);
    contents.grids.push_back(readable(name));
    demand(end < std::uint64_t(1) << 62 && static_cast<std::streamoff>(end) > file.place());
    file.go_to(static_cast<std::streamoff>(end));
  }
}

}  // namespace

std::optional<VdbContents> vdb_contents(const std::string& path) {
  VdbContents contents;
  bool head_read = false;
  try {
    HeadReader file(path);
    demand(file.number(8) == vdb_magic);
    demand(file.number(4) >= oldest_version);
    file.skip(2 * 4 + 1 + uuid_length);  // OpenVDB's version, whether grids can be skipped, an identifier
    head_read = true;
    const std::uint64_t count = file.number(4);
    demand(count <= most_names);
    for (std::uint64_t i = 0; i < count; ++i) {
      contents.metadata.push_back(file.name());
      file.name();  // the type
      file.skip(static_cast<std::streamoff>(file.number(4)));
    }
    read_grids(file, contents);
  } catch (const Unreadable&) {
    if (!head_read) return {};
  }
  return contents;
}

}  // namespace meshcomplete
