#pragma once

#include <span>
#include <string>
#include <string_view>

namespace patina {

/// The least number of letters to insert, delete, replace or swap with their neighbour that turns `a` into `b` (optimal
/// string alignment). Bytes count as letters.
size_t edit_distance(std::string_view a, std::string_view b);

/// The word of `known` that was meant, for the end of a message: "; did you mean 'frames'?". It is the one at the
/// smallest edit distance, the first of equals; empty where more than a third of the letters would have to change.
std::string did_you_mean(std::string_view word, std::span<const std::string> known);

}  // namespace patina
