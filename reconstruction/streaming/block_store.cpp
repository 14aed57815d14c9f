#include "reconstruction/streaming/block_store.h"

#include <algorithm>
#include <iterator>
#include <new>

#include <zstd.h>

#include "engine/core/error.h"
#include "passes/state/block_keys.h"

namespace patina {

namespace {

constexpr size_t kWords = gpu::kBlockVoxels;
constexpr size_t kMostBytes = 3 * kWords * sizeof(uint32_t);
constexpr int kLevel = 1;  // 1: what leaves is compressed while frames go on

using Bytes = std::array<std::byte, kMostBytes>;

/// The first bytes of all words, then the second ones, and so on: neighbours are alike byte by byte.
void shuffle(std::span<const uint32_t> words, std::byte* out) {
    for (size_t i = 0; i < words.size(); ++i) {
        for (size_t b = 0; b < 4; ++b) out[b * words.size() + i] = static_cast<std::byte>(words[i] >> 8 * b);
    }
}

void unshuffle(const std::byte* in, std::span<uint32_t> words) {
    for (size_t i = 0; i < words.size(); ++i) {
        uint32_t word = 0;
        for (size_t b = 0; b < 4; ++b) word |= std::to_integer<uint32_t>(in[b * words.size() + i]) << 8 * b;
        words[i] = word;
    }
}

/// Replaces labels by their places in `labels`, which it fills.
std::array<uint32_t, kWords> index_labels(std::span<const uint32_t> words,
                                          std::vector<BlockStore::Kept::Label>& labels) {
    std::array<uint32_t, kWords> indexed{};
    for (size_t i = 0; i < words.size(); ++i) {
        const auto label = static_cast<uint16_t>(words[i]);
        auto at = std::find_if(labels.begin(), labels.end(), [&](const auto& l) { return l.label == label; });
        if (at == labels.end()) at = labels.insert(at, {label, 0});
        ++at->voxels;
        indexed[i] = (words[i] & 0xffff0000u) | static_cast<uint32_t>(at - labels.begin());
    }
    return indexed;
}

template <class Context>
Context* made(Context* context) {
    if (!context) throw std::bad_alloc();
    return context;
}

/// The cell that a block lies in: its coordinates in units of cells, as keys have them.
constexpr uint32_t kCellShift = 4, kCellEdge = 1u << kCellShift;
constexpr uint32_t kWithinCell = (kCellEdge - 1) | (kCellEdge - 1) << 11 | (kCellEdge - 1) << 21;
uint32_t cell_of(uint32_t key) { return key & ~kWithinCell; }

uint32_t part_number(uint32_t key) { return hash_of_key(key) % gpu::kSweepParts; }

}  // namespace

void BlockStore::Free::operator()(ZSTD_CCtx_s* context) const { ZSTD_freeCCtx(context); }
void BlockStore::Free::operator()(ZSTD_DCtx_s* context) const { ZSTD_freeDCtx(context); }

BlockStore::BlockStore(uint64_t most_bytes)
    : most_bytes_(most_bytes), compressor_(made(ZSTD_createCCtx())), decompressor_(made(ZSTD_createDCtx())) {}
BlockStore::~BlockStore() = default;

const BlockStore::Part& BlockStore::part_of(uint32_t key) const { return parts_[part_number(key)]; }
BlockStore::Part& BlockStore::part_of(uint32_t key) { return parts_[part_number(key)]; }

void BlockStore::put(const gpu::StreamedBlock& block, const BlockWords& words) {
    Kept kept;
    kept.label_stamp = block.label_stamp;
    Bytes bytes;
    shuffle(words.tsdf, bytes.data());
    shuffle(words.color, bytes.data() + kWords * 4);
    const bool labelled = !words.labels.empty();
    if (labelled) shuffle(index_labels(words.labels, kept.labels), bytes.data() + kWords * 8);
    std::array<std::byte, ZSTD_COMPRESSBOUND(kMostBytes)> packed;
    const size_t size = ZSTD_compressCCtx(compressor_.get(), packed.data(), packed.size(), bytes.data(),
                                          labelled ? kMostBytes : kMostBytes / 3 * 2, kLevel);
    if (ZSTD_isError(size)) throw std::bad_alloc();
    kept.packed.assign(packed.begin(), packed.begin() + static_cast<std::ptrdiff_t>(size));
    put_back(block.key, std::move(kept));
}

void BlockStore::put_back(uint32_t key, Kept&& kept) {
    Cell& cell = cells_[cell_of(key)];
    // Once there is room for the key and an entry, nothing fails any more.
    if (cell.keys.size() == cell.keys.capacity()) cell.keys.reserve(2 * cell.keys.size() + 1);
    const auto [entry, is_new] = part_of(key).try_emplace(key);
    if (is_new) {
        cell.keys.push_back(key);
    } else {
        count(cell, entry->second, false);
    }
    entry->second = std::move(kept);
    count(cell, entry->second, true);
}

void BlockStore::count(Cell& cell, const Kept& kept, bool comes) {
    for (uint64_t* bytes : {&bytes_, &cell.bytes}) *bytes += comes ? kept.packed.size() : -kept.packed.size();
    blocks_in_file_ += comes ? uint32_t{kept.in_file} : -uint32_t{kept.in_file};
}

std::vector<std::byte> BlockStore::packed_of(uint32_t key, const Kept& kept) const {
    return kept.in_file ? file_->read(key) : kept.packed;
}

void BlockStore::make_room(const gpu::VoxelGrid& grid, glm::dvec3 from_m) {
    if (most_bytes_ == 0 || bytes_ <= most_bytes_) {
        try_at_ = 0;
        problem_.clear();
        return;
    }
    if (bytes_ <= try_at_) return;
    try {
        const double block_m = double{grid.voxel_m} * gpu::kBlockEdge;
        std::vector<std::pair<double, uint32_t>> farthest;  // distance, cell
        for (const auto& [key, cell] : cells_) {
            if (cell.bytes == 0) continue;
            const glm::dvec3 center = glm::dvec3(block_of_key(grid, key)) + kCellEdge / 2.0;
            farthest.emplace_back(glm::distance(center * block_m, from_m), key);
        }
        std::sort(farthest.rbegin(), farthest.rend());
        if (!file_) file_ = std::make_unique<SpillFile>();
        for (auto at = farthest.begin(); at != farthest.end() && bytes_ > most_bytes_ / 4 * 3; ++at)
            move_to_file(cells_.at(at->second));
        try_at_ = 0;
        problem_.clear();
    } catch (const std::exception& error) {
        try_at_ = bytes_ + most_bytes_ / 4;
        problem_ = reason_of(error);
    }
}

void BlockStore::move_to_file(Cell& cell) {
    std::vector<std::pair<uint32_t, std::span<const std::byte>>> entries;
    for (const uint32_t key : cell.keys) {
        const Kept& kept = part_of(key).at(key);
        if (!kept.in_file) entries.emplace_back(key, kept.packed);
    }
    file_->put(entries);
    filed_ += entries.size();
    for (const auto& [key, bytes] : entries) {
        Kept& kept = part_of(key).at(key);
        count(cell, kept, false);
        std::vector<std::byte>().swap(kept.packed);  // gives its memory back
        kept.in_file = true;
        count(cell, kept, true);
    }
}

gpu::StreamedBlock BlockStore::read(uint32_t key, std::span<uint32_t> tsdf, std::span<uint32_t> color,
                                    std::span<uint32_t> labels) const {
    const Kept& kept = part_of(key).at(key);
    const std::vector<std::byte> from_file = kept.in_file ? file_->read(key) : std::vector<std::byte>();
    const std::vector<std::byte>& packed = kept.in_file ? from_file : kept.packed;
    Bytes bytes;
    const size_t size =
        ZSTD_decompressDCtx(decompressor_.get(), bytes.data(), bytes.size(), packed.data(), packed.size());
    const size_t expected = labels.empty() ? kMostBytes / 3 * 2 : kMostBytes;
    if (ZSTD_isError(size)) throw Error("voxel block ", key, ", which was away, is damaged: ", ZSTD_getErrorName(size));
    if (size != expected) throw Error("voxel block ", key, ", which was away, has ", size, " bytes, not ", expected);
    unshuffle(bytes.data(), tsdf);
    unshuffle(bytes.data() + kWords * 4, color);
    if (!labels.empty()) {
        unshuffle(bytes.data() + kWords * 8, labels);
        // As sweep_labels.comp does: a label that was given up takes its confidence along.
        for (uint32_t& word : labels) {
            const uint32_t label = kept.labels.at(word & 0xffff).label;
            word = label == 0 ? 0 : (word & 0xffff0000u) | label;
        }
    }
    return {key, 0, kept.label_stamp, 0};
}

BlockStore::Kept BlockStore::take(uint32_t key) {
    Part& part = part_of(key);
    const auto at = part.find(key);
    PATINA_ASSERT(at != part.end(), "no block ", key, " is away");
    const auto cell = cells_.find(cell_of(key));
    count(cell->second, at->second, false);
    Kept kept = std::move(at->second);
    part.erase(at);
    std::erase(cell->second.keys, key);
    if (cell->second.keys.empty()) cells_.erase(cell);
    return kept;
}

std::vector<uint32_t> BlockStore::keys(const gpu::VoxelGrid& grid, const StreamRegion& region) const {
    std::vector<uint32_t> keys;
    for (const auto& [lowest, cell] : cells_) {
        if (cell.keys.empty() || !region.meets(grid, block_of_key(grid, lowest), kCellEdge)) continue;
        std::copy_if(cell.keys.begin(), cell.keys.end(), std::back_inserter(keys),
                     [&](uint32_t key) { return region.holds(grid, block_of_key(grid, key)); });
    }
    std::sort(keys.begin(), keys.end());
    return keys;
}

std::vector<uint32_t> BlockStore::count_labels(uint32_t part, uint32_t capacity) const {
    std::vector<uint32_t> counts(capacity);
    for (const auto& [key, kept] : parts_.at(part)) {
        for (const auto& [label, voxels] : kept.labels) {
            if (label != 0 && label < capacity) counts[label] += voxels;
        }
    }
    return counts;
}

void BlockStore::relabel(uint32_t part, std::span<const uint32_t> parents) {
    for (auto& [key, kept] : parts_.at(part)) {
        for (auto& [label, voxels] : kept.labels) {
            if (label < parents.size()) label = static_cast<uint16_t>(parents[label]);
        }
    }
}

uint32_t BlockStore::blocks() const {
    size_t blocks = 0;
    for (const Part& part : parts_) blocks += part.size();
    return static_cast<uint32_t>(blocks);
}

void BlockStore::clear() {
    for (Part& part : parts_) part.clear();
    cells_.clear();
    file_.reset();
    bytes_ = try_at_ = blocks_in_file_ = 0;
    problem_.clear();
}

void BlockStore::visit(graph::StateVisitor& visitor, const gpu::VoxelGrid& grid) {
    if (visitor.brings_back()) clear();
    for (uint32_t i = 0; i < parts_.size(); ++i) {
        visit_part(visitor, i);
        if (visitor.brings_back()) make_room(grid, glm::dvec3(0));
    }
}

void BlockStore::visit_part(graph::StateVisitor& visitor, uint32_t part) {
    std::vector<uint32_t> heads;  // key, stamp, labels, bytes; of each block
    std::vector<Kept::Label> labels;
    std::vector<std::byte> all;
    for (const auto& [key, kept] : parts_[part]) {
        const std::vector<std::byte> packed = packed_of(key, kept);
        heads.insert(heads.end(), {key, kept.label_stamp, static_cast<uint32_t>(kept.labels.size()),
                                   static_cast<uint32_t>(packed.size())});
        labels.insert(labels.end(), kept.labels.begin(), kept.labels.end());
        all.insert(all.end(), packed.begin(), packed.end());
    }
    const std::string name = text("away.", part);
    visitor.values(name + ".blocks", heads);
    visitor.values(name + ".labels", labels);
    visitor.values(name + ".voxels", all);
    if (!visitor.brings_back()) return;
    auto label = labels.cbegin();
    auto byte = all.cbegin();
    for (size_t at = 0; at + 4 <= heads.size(); at += 4) {
        const auto label_count = static_cast<std::ptrdiff_t>(heads[at + 2]);
        const auto byte_count = static_cast<std::ptrdiff_t>(heads[at + 3]);
        if (labels.cend() - label < label_count || all.cend() - byte < byte_count)
            throw Error("'", name, "' ends within a block");
        put_back(heads[at], {heads[at + 1], {label, label + label_count}, {byte, byte + byte_count}});
        label += label_count;
        byte += byte_count;
    }
}

}  // namespace patina
