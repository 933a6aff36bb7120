// A seal at the end of a file, by which damage is noticed before anything is made of the content.
#pragma once

#include <string>

#include "common/core/progress.h"

namespace meshcomplete {

enum class FileSeal {
  whole,    ///< sealed, and as it was then
  damaged,  ///< sealed, and changed since
  absent    ///< no seal at the end: never sealed, or cut off
};

/// Appends the seal: the length and a checksum (CRC-32) of all that stands before it. Programs that know the
/// content's end, like OpenVDB's, do not see it. Throws std::ios_base::failure. Cost: reads the file once.
void seal_file(const std::string& path, const Progress& progress);

/// Throws std::ios_base::failure when the file cannot be read. Cost: reads the file once.
FileSeal check_seal(const std::string& path, const Progress& progress);

}  // namespace meshcomplete
