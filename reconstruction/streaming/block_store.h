#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/graph/state_visitor.h"
#include "reconstruction/store/spill_file.h"
#include "reconstruction/streaming/stream_region.h"
#include "shared/segmentation/segments.h"

namespace patina {

/// Blocks that are away from the device, compressed in the host's memory, and beyond a limit in a temporary file. Their
/// labels are kept apart, in memory, so that they can be counted and replaced where they are.
class BlockStore {
  public:
    /// `most_bytes`: of compressed blocks in memory (make_room()); 0: all. `name`: of its state (visit()).
    explicit BlockStore(uint64_t most_bytes = 0, std::string name = "away");
    BlockStore(const BlockStore&) = delete;
    BlockStore& operator=(const BlockStore&) = delete;

    /// What is kept of one block.
    struct Kept {
        struct Label {
            uint16_t label = 0;
            uint16_t voxels = 0;
        };
        uint32_t label_stamp = 0;
        std::vector<Label> labels;      ///< that occur; in `packed` stand their places in this list
        std::vector<std::byte> packed;  ///< all words, compressed; in the file: empty
        bool in_file = false;

        /// The label with which a word begins, in place of its place in the list. One that was given up takes what
        /// else the word holds along, as sweep_labels.comp does.
        uint32_t with_label(uint32_t word) const {
            const uint32_t label = labels.at(word & 0xffff).label;
            return label == 0 ? 0 : (word & 0xffff0000u) | label;
        }
        /// The other way; adds a label that is not in the list.
        uint32_t with_place(uint32_t word);
    };

    /// Keeps a block; one of the same key is replaced. Throws std::bad_alloc; then nothing has changed.
    void put(uint32_t key, Kept&& kept);
    /// Of a block that is here.
    const Kept& at(uint32_t key) const { return part_of(key).at(key); }
    /// Kept::packed, wherever it is. Throws Error where the file cannot be read.
    std::vector<std::byte> packed(uint32_t key) const;
    /// Takes a block out.
    Kept take(uint32_t key);

    /// The keys of the blocks within a region, in ascending order.
    std::vector<uint32_t> keys(const gpu::VoxelGrid& grid, const StreamRegion& region) const;

    /// Of one part of the sweep over all labels (segmentation/sweep_labels.h): the voxels of each label below
    /// `capacity`; and the replacement of labels by `parents`, by label.
    std::vector<uint32_t> count_labels(uint32_t part, uint32_t capacity) const;
    void relabel(uint32_t part, std::span<const uint32_t> parents);

    /// Where more than the limit is in memory, the blocks farthest from a point go to the file, until three quarters of
    /// the limit are left. Where the file cannot be written, blocks stay in memory, and problem() says so; the next
    /// attempt is made when they have become a quarter of the limit more.
    void make_room(const gpu::VoxelGrid& grid, glm::dvec3 from_m);

    uint32_t blocks() const;
    uint64_t voxels() const { return voxels_; }  ///< whose labels are kept
    uint32_t blocks_in_file() const { return blocks_in_file_; }
    uint64_t filed() const { return filed_; }            ///< blocks that ever went to the file
    uint64_t bytes_in_memory() const { return bytes_; }  ///< of compressed blocks
    /// Why blocks are in memory that should not be; empty where none are.
    const std::string& problem() const { return problem_; }

    void clear();
    void visit(graph::StateVisitor& visitor, const gpu::VoxelGrid& grid);

  private:
    using Part = std::map<uint32_t, Kept>;
    /// Of 16^3 blocks.
    struct Cell {
        std::vector<uint32_t> keys;
        uint64_t bytes = 0;  ///< of them in memory
    };
    void count(Cell& cell, const Kept& kept, bool comes);
    void move_to_file(Cell& cell);
    void visit_part(graph::StateVisitor& visitor, uint32_t part);
    const Part& part_of(uint32_t key) const;
    Part& part_of(uint32_t key);

    std::map<uint32_t, Cell> cells_;  ///< by the key of their lowest block
    std::array<Part, gpu::kSweepParts> parts_;
    uint64_t most_bytes_;
    uint64_t bytes_ = 0, try_at_ = 0;  ///< in memory; and how many there are when it is tried again
    uint32_t blocks_in_file_ = 0;
    uint64_t voxels_ = 0;
    uint64_t filed_ = 0;
    std::string problem_;
    std::unique_ptr<SpillFile> file_;  ///< null until something goes there
    std::string name_;
};

}  // namespace patina
