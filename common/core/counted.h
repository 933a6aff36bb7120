// Numbers of things in messages, with the verb and the ending that go with them.
#pragma once

#include <cstddef>
#include <string>

namespace meshcomplete {

/// "1 <one>" or "<count> <many>".
inline std::string counted(std::size_t count, const std::string& one, const std::string& many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

/// "The <thing> <one>" where there is only one, else "1 of the <all> <things> <one>" or "<count> of the <all>
/// <things> <many>".
inline std::string counted_of(std::size_t count, std::size_t all, const std::string& thing,
                              const std::string& things, const std::string& one, const std::string& many) {
  if (all == 1) return "The " + thing + " " + one;
  return std::to_string(count) + " of the " + std::to_string(all) + " " + things + " " +
         (count == 1 ? one : many);
}

}  // namespace meshcomplete
