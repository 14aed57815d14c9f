#pragma once

#include <cstring>
#include <vector>

namespace patina {

template <class Element>
bool same_bytes(const std::vector<Element>& a, const std::vector<Element>& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Element)) == 0);
}

}  // namespace patina
