#include "engine/core/did_you_mean.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace patina {

namespace {

constexpr size_t kLongest = 100;  // letters; no name is as long, and the work grows with the square

}  // namespace

size_t edit_distance(std::string_view a, std::string_view b) {
    // Rows of the table of distances between the first i letters of a and the first j of b.
    std::vector<size_t> before_last, last(b.size() + 1), current(b.size() + 1);
    std::iota(last.begin(), last.end(), size_t{0});
    for (size_t i = 1; i <= a.size(); ++i) {
        current[0] = i;
        for (size_t j = 1; j <= b.size(); ++j) {
            current[j] = std::min({last[j] + 1, current[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
            const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
            if (swapped) current[j] = std::min(current[j], before_last[j - 2] + 1);
        }
        before_last = last;
        std::swap(last, current);
    }
    return last.back();
}

std::string did_you_mean(std::string_view word, std::span<const std::string> known) {
    if (word.size() > kLongest) return "";
    const std::string* nearest = nullptr;
    size_t least = 0;
    for (const std::string& candidate : known) {
        const size_t distance = edit_distance(word, candidate);
        if (3 * distance > std::max(word.size(), candidate.size())) continue;
        if (nearest && distance >= least) continue;
        nearest = &candidate;
        least = distance;
    }
    return nearest ? "; did you mean '" + *nearest + "'?" : "";
}

}  // namespace patina
