#include "reconstruction/streaming/block_store.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "engine/core/error.h"
#include "passes/state/block_keys.h"

namespace patina {

namespace {

/// The cell that a block lies in: its coordinates in units of cells, as keys have them.
constexpr uint32_t kCellShift = 4, kCellEdge = 1u << kCellShift;
constexpr uint32_t kWithinCell = (kCellEdge - 1) | (kCellEdge - 1) << 11 | (kCellEdge - 1) << 21;
uint32_t cell_of(uint32_t key) { return key & ~kWithinCell; }

uint32_t part_number(uint32_t key) { return hash_of_key(key) % gpu::kSweepParts; }

}  // namespace

uint32_t BlockStore::Kept::with_place(uint32_t word) {
    const auto label = static_cast<uint16_t>(word);
    auto at = std::find_if(labels.begin(), labels.end(), [&](const Label& l) { return l.label == label; });
    if (at == labels.end()) at = labels.insert(at, {label, 0});
    ++at->voxels;
    return (word & 0xffff0000u) | static_cast<uint32_t>(at - labels.begin());
}

BlockStore::BlockStore(uint64_t most_bytes, std::string name) : most_bytes_(most_bytes), name_(std::move(name)) {}

const BlockStore::Part& BlockStore::part_of(uint32_t key) const { return parts_[part_number(key)]; }
BlockStore::Part& BlockStore::part_of(uint32_t key) { return parts_[part_number(key)]; }

void BlockStore::put(uint32_t key, Kept&& kept) {
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
    for (const Kept::Label& label : kept.labels) voxels_ += comes ? uint64_t{label.voxels} : -uint64_t{label.voxels};
}

std::vector<std::byte> BlockStore::packed(uint32_t key) const {
    const Kept& kept = at(key);
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
    bytes_ = try_at_ = blocks_in_file_ = voxels_ = 0;
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
        const std::vector<std::byte> packed = this->packed(key);
        heads.insert(heads.end(), {key, kept.label_stamp, static_cast<uint32_t>(kept.labels.size()),
                                   static_cast<uint32_t>(packed.size())});
        labels.insert(labels.end(), kept.labels.begin(), kept.labels.end());
        all.insert(all.end(), packed.begin(), packed.end());
    }
    const std::string name = text(name_, ".", part);
    visitor.values(name + ".blocks", heads);
    visitor.values(name + ".labels", labels);
    visitor.values(name + ".packed", all);
    if (!visitor.brings_back()) return;
    auto label = labels.cbegin();
    auto byte = all.cbegin();
    for (size_t at = 0; at + 4 <= heads.size(); at += 4) {
        const auto label_count = static_cast<std::ptrdiff_t>(heads[at + 2]);
        const auto byte_count = static_cast<std::ptrdiff_t>(heads[at + 3]);
        if (labels.cend() - label < label_count || all.cend() - byte < byte_count)
            throw Error("'", name, "' ends within a block");
        put(heads[at], {heads[at + 1], {label, label + label_count}, {byte, byte + byte_count}});
        label += label_count;
        byte += byte_count;
    }
}

}  // namespace patina
