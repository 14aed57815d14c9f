#include "tests/graph/random_frame.h"

#include <algorithm>
#include <numeric>
#include <random>
#include <string>

namespace patina::graph {
namespace {

class Random {
  public:
    explicit Random(uint32_t seed) : engine_(seed) {}
    /// Uniform enough for tests, and the same with every standard library.
    uint32_t below(uint32_t bound) { return static_cast<uint32_t>(engine_() % bound); }
    bool one_in(uint32_t n) { return below(n) == 0; }

  private:
    std::mt19937 engine_;
};

Resource make_resource(Random& random, uint32_t index) {
    Resource resource{"r" + std::to_string(index), ResourceKind::kBuffer, random.one_in(3), {}};
    if (random.one_in(2)) resource.kind = ResourceKind::kImage;
    if (!resource.imported) resource.need = {1 + random.below(64), uint64_t{1} << random.below(5)};
    return resource;
}

Use make_use(Random& random, const Resource& resource, uint32_t version) {
    if (!resource.imported && version == 0) return random.one_in(3) ? Use::kTransferWrite : Use::kStorageWrite;
    for (;;) {
        const Use use = static_cast<Use>(random.below(8));
        const bool buffer_only = use == Use::kUniform || use == Use::kIndirect;
        if (!buffer_only || resource.kind == ResourceKind::kBuffer) return use;
    }
}

/// `count` different numbers from begin..begin+size-1.
std::vector<uint32_t> draw(Random& random, uint32_t begin, uint32_t size, uint32_t count) {
    std::vector<uint32_t> all(size);
    std::iota(all.begin(), all.end(), begin);
    for (uint32_t i = 0; i < count; ++i) std::swap(all[i], all[i + random.below(size - i)]);
    all.resize(count);
    return all;
}

}  // namespace

Description make_random_frame(uint32_t seed) {
    Random random(seed);
    Description description;
    const uint32_t resource_count = 2 + random.below(15);
    for (uint32_t i = 0; i < resource_count; ++i) description.resources.push_back(make_resource(random, i));
    std::vector<uint32_t> versions(resource_count, 0);
    const uint32_t pass_count = 1 + random.below(24);
    const uint32_t window = std::min(5u, resource_count);
    for (uint32_t i = 0; i < pass_count; ++i) {
        Pass pass{"p" + std::to_string(i), {}};
        // The passes move on over the resources, which keeps lifetimes short enough to share memory.
        const uint32_t begin = i * (resource_count - window + 1) / pass_count;
        for (uint32_t resource : draw(random, begin, window, 1 + random.below(std::min(4u, window)))) {
            const Use use = make_use(random, description.resources[resource], versions[resource]);
            pass.accesses.push_back({resource, versions[resource], use});
            versions[resource] += writes(use) ? 1 : 0;
        }
        description.passes.push_back(std::move(pass));
    }
    for (uint32_t resource = 0; resource < resource_count; ++resource) {
        const bool exists = description.resources[resource].imported || versions[resource] > 0;
        if (exists && random.one_in(3)) description.kept.push_back({resource, versions[resource]});
    }
    return description;
}

}  // namespace patina::graph
