#include "reconstruction/streaming/voxel_codec.h"

#include <algorithm>
#include <array>
#include <vector>

#include "engine/core/error.h"

namespace patina {

namespace {

constexpr size_t kWords = gpu::kBlockVoxels;

}  // namespace

BlockStore::Kept pack_voxels(Packer& packer, uint32_t label_stamp, const VoxelWords<const uint32_t>& words) {
    BlockStore::Kept kept;
    kept.label_stamp = label_stamp;
    std::array<uint32_t, 3 * kWords> all;
    auto end = std::copy(words.tsdf.begin(), words.tsdf.end(), all.begin());
    end = std::copy(words.color.begin(), words.color.end(), end);
    for (const uint32_t word : words.labels) *end++ = kept.with_place(word);
    kept.packed = packer.pack({all.begin(), end});
    return kept;
}

void unpack_voxels(Packer& packer, const BlockStore& store, uint32_t key, const VoxelWords<uint32_t>& words) {
    const size_t expected = (words.labels.empty() ? 2 : 3) * kWords;
    try {
        const std::vector<uint32_t> all = packer.unpack(store.packed(key), expected);
        if (all.size() != expected) throw Error("has ", all.size(), " words, not ", expected);
        const auto at = [&](size_t array) { return all.begin() + static_cast<std::ptrdiff_t>(array * kWords); };
        std::copy_n(at(0), kWords, words.tsdf.begin());
        std::copy_n(at(1), kWords, words.color.begin());
        const BlockStore::Kept& kept = store.at(key);
        if (!words.labels.empty())
            std::transform(at(2), all.end(), words.labels.begin(),
                           [&](uint32_t word) { return kept.with_label(word); });
    } catch (const Error& error) {
        throw Error("voxel block ", key, ", which was away, ", error.what());
    }
}

}  // namespace patina
