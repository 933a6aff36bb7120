#include "filter_volmorph/file_seal.h"

#include <algorithm>
#include <array>
#include <boost/crc.hpp>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <vector>

namespace meshcomplete {
namespace {

constexpr std::array<char, 8> seal_name = {'\n', 'S', 'E', 'A', 'L', 'E', 'D', '\n'};
constexpr std::size_t number_bytes = 8;
constexpr std::uint64_t seal_size = seal_name.size() + 2 * number_bytes;
constexpr std::size_t bytes_at_once = 1 << 20;

using SealBytes = std::array<char, seal_size>;

/// Of so many bytes from the file's beginning.
std::uint32_t checksum(std::istream& file, std::uint64_t length, const Progress& progress) {
  boost::crc_32_type sum;
  std::vector<char> bytes(bytes_at_once);
  file.seekg(0);
  for (std::uint64_t done = 0; done < length;) {
    const std::uint64_t count = std::min<std::uint64_t>(bytes.size(), length - done);
    file.read(bytes.data(), static_cast<std::streamsize>(count));
    sum.process_bytes(bytes.data(), count);
    done += count;
    progress.update(double(done) / double(length));
  }
  return sum.checksum();
}

SealBytes seal(std::uint64_t length, std::uint32_t sum) {
  SealBytes bytes;
  std::copy(seal_name.begin(), seal_name.end(), bytes.begin());
  // Lowest byte first, on every machine.
  for (std::size_t i = 0; i < number_bytes; ++i) {
    bytes[seal_name.size() + i] = static_cast<char>(length >> (8 * i) & 0xff);
    bytes[seal_name.size() + number_bytes + i] = static_cast<char>(std::uint64_t(sum) >> (8 * i) & 0xff);
  }
  return bytes;
}

std::uint64_t length_of(std::istream& file) {
  file.seekg(0, std::ios::end);
  return static_cast<std::uint64_t>(file.tellg());
}

}  // namespace

void seal_file(const std::string& path, const Progress& progress) {
  std::fstream file;
  file.exceptions(std::ios::failbit | std::ios::badbit);
  file.open(path, std::ios::in | std::ios::out | std::ios::binary);
  const std::uint64_t length = length_of(file);
  const SealBytes bytes = seal(length, checksum(file, length, progress));
  file.seekp(0, std::ios::end);
  file.write(bytes.data(), bytes.size());
  file.close();
}

FileSeal check_seal(const std::string& path, const Progress& progress) {
  std::ifstream file;
  file.exceptions(std::ios::failbit | std::ios::badbit);
  file.open(path, std::ios::binary);
  const std::uint64_t all = length_of(file);
  if (all < seal_size) return FileSeal::absent;
  SealBytes found;
  file.seekg(static_cast<std::streamoff>(all - seal_size));
  file.read(found.data(), found.size());
  if (!std::equal(seal_name.begin(), seal_name.end(), found.begin())) return FileSeal::absent;
  const std::uint64_t length = all - seal_size;
  return found == seal(length, checksum(file, length, progress)) ? FileSeal::whole : FileSeal::damaged;
}

}  // namespace meshcomplete
