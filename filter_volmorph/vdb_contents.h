// What is in a .vdb file that may be foreign or damaged, without trusting it.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace meshcomplete {

struct VdbContents {
  std::vector<std::string> metadata;  ///< the names of what belongs to the file as a whole
  std::vector<std::string> grids;     ///< names, as far as they can be read
};

/// Reads only the file's head and the heads of its grids. OpenVDB's own reader believes every count and
/// length that it reads, and takes long or much memory where they are damaged; this one does not. Nothing
/// when the file cannot be read or is no .vdb of file version 222 (2013) or later.
std::optional<VdbContents> vdb_contents(const std::string& path);

}  // namespace meshcomplete
