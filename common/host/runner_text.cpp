#include "common/host/runner_text.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>

#include "common/core/error.h"

namespace meshcomplete {
namespace host {

bool TextLines::read_line() {
  if (!std::getline(in_, line_)) return false;
  const auto strip = [this] {
    while (!line_.empty() && (line_.back() == '\r' || line_.back() == ' ')) line_.pop_back();
  };
  strip();
  while (continued_ && !line_.empty() && line_.back() == '\\') {
    std::string more;
    line_.pop_back();
    if (!std::getline(in_, more)) break;
    line_ += more;
    strip();
  }
  line_.resize(std::min(line_.find('#'), line_.size()));
  return true;
}

bool TextLines::next() {
  tokens_.clear();
  while (tokens_.empty()) {
    if (!read_line()) return false;
    const std::string_view line(line_);
    for (std::size_t at = 0; (at = line.find_first_not_of(" \t\r", at)) != std::string_view::npos;) {
      const std::size_t end = std::min(line.find_first_of(" \t\r", at), line.size());
      tokens_.push_back(line.substr(at, end - at));
      at = end;
    }
  }
  return true;
}

std::string TextLines::joined() const {
  std::string text;
  for (const std::string_view token : tokens_) {
    if (!text.empty()) text += ' ';
    text += token;
  }
  return text;
}

TextFile::TextFile(const std::string& text) : descriptor_(memfd_create("mesh", MFD_CLOEXEC)) {
  std::size_t written = 0;
  while (descriptor_ >= 0 && written < text.size()) {
    const ssize_t count = write(descriptor_, text.data() + written, text.size() - written);
    if (count <= 0) break;
    written += static_cast<std::size_t>(count);
  }
  if (written < text.size()) throw CompletionError("reading the file", "there is not enough memory for it");
}

TextFile::~TextFile() {
  if (descriptor_ >= 0) close(descriptor_);
}

std::string TextFile::path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

}  // namespace host
}  // namespace meshcomplete
