// What a benchmark is asked for on its command line: some of its parts, and files.
#pragma once

#include <set>
#include <string>
#include <vector>

namespace meshcomplete::benchmarks {

struct Arguments {
  /// What is not one of the words `parts` is a file.
  Arguments(int argc, char** argv, const std::set<std::string>& parts) {
    for (int i = 1; i < argc; ++i) {
      if (parts.count(argv[i]) > 0)
        asked.insert(argv[i]);
      else
        files.push_back(argv[i]);
    }
  }

  /// Without a word, every part is.
  bool wanted(const std::string& part) const { return asked.empty() || asked.count(part) > 0; }

  std::set<std::string> asked;
  std::vector<std::string> files;
};

}  // namespace meshcomplete::benchmarks
