#include "reconstruction/streaming/block_store.h"

#include <cstdlib>
#include <filesystem>
#include <map>
#include <optional>
#include <random>

#include <gmock/gmock.h>

#include "passes/state/block_keys.h"
#include "reconstruction/streaming/voxel_codec.h"
#include "tests/export/temporary_folder.h"
#include "tests/support/file_size_limit.h"

namespace patina::block_store_test {
namespace {

constexpr size_t kWords = gpu::kBlockVoxels;

struct Words {
    std::vector<uint32_t> tsdf, color, labels;

    VoxelWords<const uint32_t> spans() const { return {tsdf, color, labels}; }
    bool operator==(const Words&) const = default;
};

Words random_words(std::mt19937& random, uint32_t labels) {
    Words words{std::vector<uint32_t>(kWords), std::vector<uint32_t>(kWords),
                std::vector<uint32_t>(labels ? kWords : 0)};
    for (uint32_t& word : words.tsdf) word = random();
    for (uint32_t& word : words.color) word = random();
    for (uint32_t& word : words.labels) {
        const uint32_t label = random() % labels;
        word = label == 0 ? 0 : label | random() % 256 << 16;
    }
    return words;
}

void put_words(BlockStore& store, uint32_t key, uint32_t stamp, const Words& words) {
    Packer packer;
    store.put(key, pack_voxels(packer, stamp, words.spans()));
}

Words read(const BlockStore& store, uint32_t key, bool labelled, uint32_t* stamp = nullptr) {
    Words words{std::vector<uint32_t>(kWords), std::vector<uint32_t>(kWords),
                std::vector<uint32_t>(labelled ? kWords : 0)};
    Packer packer;
    unpack_voxels(packer, store, key, {words.tsdf, words.color, words.labels});
    if (stamp) *stamp = store.at(key).label_stamp;
    return words;
}

/// Keeps what is visited, or brings it back.
class MemoryVisitor : public graph::StateVisitor {
  public:
    explicit MemoryVisitor(bool keeps) : keeps_(keeps) {}
    void reverse() { keeps_ = false; }
    bool brings_back() const override { return !keeps_; }
    void buffer(vulkan::BufferRef&) override {}
    void array(vulkan::ChunkedBuffer&) override {}
    void image(vulkan::ImageRef&) override {}
    void bytes(const std::string& name, std::vector<std::byte>& bytes) override {
        if (keeps_) {
            EXPECT_TRUE(kept.emplace(name, bytes).second) << name << " comes twice";
        } else {
            bytes = kept.at(name);
        }
    }

    std::map<std::string, std::vector<std::byte>> kept;

  private:
    bool keeps_;
};

TEST(BlockStore, GivesBackWhatItWasGiven) {
    std::mt19937 random(3);
    for (const uint32_t labels : {0u, 1u, 5u, 600u}) {
        BlockStore store;
        std::map<uint32_t, Words> blocks;
        for (uint32_t i = 0; i < 40; ++i) {
            const uint32_t key = random() & 0x7fffffffu;
            blocks[key] = random_words(random, labels);
            put_words(store, key, i, blocks[key]);
        }
        EXPECT_EQ(store.blocks(), blocks.size());
        for (const auto& [key, words] : blocks) {
            EXPECT_EQ(read(store, key, labels > 0), words);
            BlockStore::Kept kept = store.take(key);
            EXPECT_EQ(store.blocks(), blocks.size() - 1);
            store.put(key, std::move(kept));
            EXPECT_EQ(read(store, key, labels > 0), words);
        }
        store.clear();
        EXPECT_EQ(store.blocks(), 0u);
    }
}

TEST(BlockStore, ABlockOfTheSameKeyIsReplaced) {
    std::mt19937 random(4);
    BlockStore store;
    const Words first = random_words(random, 3), second = random_words(random, 3);
    put_words(store, 42, 1, first);
    put_words(store, 42, 2, second);
    uint32_t stamp = 0;
    EXPECT_EQ(store.blocks(), 1u);
    EXPECT_EQ(read(store, 42, true, &stamp), second);
    EXPECT_EQ(stamp, 2u);
    const gpu::VoxelGrid grid{};
    EXPECT_EQ(store.keys(grid, {}), std::vector<uint32_t>{42}) << "once";
}

TEST(BlockStore, LabelsAreCountedAndReplacedByPart) {
    std::mt19937 random(5);
    constexpr uint32_t kLabels = 20;
    BlockStore store;
    std::map<uint32_t, Words> blocks;
    for (uint32_t key = 100; key < 260; ++key) {
        blocks[key] = random_words(random, kLabels);
        put_words(store, key, 0, blocks[key]);
    }
    std::vector<uint32_t> parents(kLabels);
    for (uint32_t label = 1; label < kLabels; ++label) parents[label] = label % 3 == 0 ? 0 : label % 3 == 1 ? 1 : label;
    for (uint32_t part = 0; part < gpu::kSweepParts; ++part) {
        std::vector<uint32_t> expected(kLabels);
        for (auto& [key, words] : blocks) {
            if (hash_of_key(key) % gpu::kSweepParts != part) continue;
            for (uint32_t& word : words.labels) {
                const uint32_t label = word & 0xffff, root = parents[label];
                if (label != 0) ++expected[label];
                word = root == 0 ? 0 : (word & 0xffff0000u) | root;
            }
        }
        EXPECT_EQ(store.count_labels(part, kLabels), expected);
        store.relabel(part, parents);
        for (const auto& [key, words] : blocks) {
            if (hash_of_key(key) % gpu::kSweepParts != part) continue;
            EXPECT_EQ(read(store, key, true), words);
        }
    }
}

TEST(BlockStore, KeysOfARegionAreThoseThatARegionHolds) {
    std::mt19937 random(6);
    gpu::VoxelGrid grid{};
    grid.origin_block = {5, -7, 11, 0};
    grid.voxel_m = 0.01f;
    BlockStore store;
    const Words words = random_words(random, 0);
    std::vector<uint32_t> keys;
    for (uint32_t i = 0; i < 600; ++i) {
        const uint32_t key = (1024 + random() % 60) | (512 + random() % 60) << 11 | (1024 + random() % 60) << 21;
        keys.push_back(key);
        put_words(store, key, 0, words);
    }
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    EXPECT_EQ(store.keys(grid, {}), keys);
    for (const StreamRegion& region :
         {StreamRegion::ball({2, 1.5, 3}, 1.3), StreamRegion::ball({-9, 0, 0}, 4),
          StreamRegion::box({20, 0, 20}, {40, 31, 60}), StreamRegion::box({5, -7, 11}, {5, 90, 90})}) {
        std::vector<uint32_t> expected;
        for (const uint32_t key : keys) {
            if (region.holds(grid, block_of_key(grid, key))) expected.push_back(key);
        }
        EXPECT_EQ(store.keys(grid, region), expected);
    }
    EXPECT_GT(store.keys(grid, StreamRegion::ball({2, 1.5, 3}, 1.3)).size(), 10u);
}

TEST(BlockStore, ComesBackFromItsState) {
    std::mt19937 random(7);
    BlockStore store;
    std::map<uint32_t, Words> blocks;
    for (uint32_t i = 0; i < 50; ++i) {
        const uint32_t key = random() & 0x7fffffffu;
        blocks[key] = random_words(random, 1 + i % 7);
        put_words(store, key, i, blocks[key]);
    }
    MemoryVisitor visitor(true);
    store.visit(visitor, {});
    visitor.reverse();
    BlockStore other;
    put_words(other, 1, 0, random_words(random, 2));
    other.visit(visitor, {});
    EXPECT_EQ(other.blocks(), blocks.size());
    for (const auto& [key, words] : blocks) EXPECT_EQ(read(other, key, true), words);
    EXPECT_EQ(other.keys({}, {}), store.keys({}, {}));

    visitor.kept.begin()->second.resize(visitor.kept.begin()->second.size() / 2 / 16 * 16);
    for (auto& [name, bytes] : visitor.kept) {
        if (name.ends_with(".packed") && !bytes.empty()) bytes.pop_back();
    }
    EXPECT_THROW(other.visit(visitor, {}), Error);
}

/// Temporary files go to an empty folder, or to another.
class TemporaryPlace {
  public:
    explicit TemporaryPlace(const std::string& folder = "") {
        if (const char* earlier = std::getenv("TMPDIR")) earlier_ = earlier;
        setenv("TMPDIR", folder.empty() ? folder_.path().c_str() : folder.c_str(), 1);
    }
    ~TemporaryPlace() {
        if (earlier_) {
            setenv("TMPDIR", earlier_->c_str(), 1);
        } else {
            unsetenv("TMPDIR");
        }
    }
    TemporaryPlace(const TemporaryPlace&) = delete;
    TemporaryPlace& operator=(const TemporaryPlace&) = delete;
    bool holds_nothing() const { return std::filesystem::is_empty(folder_.path()); }

  private:
    const test::TemporaryFolder folder_;
    std::optional<std::string> earlier_;
};

/// Blocks along x, one every 0.8 m, so that each cell of 16 blocks has two. Random words do not compress: 6 KiB each.
class BlockFileTest : public testing::Test {
  protected:
    static constexpr uint32_t kBlocks = 100, kCameraAt = 80;
    static constexpr uint64_t kMostBytes = 200 << 10;

    static uint32_t key(uint32_t i) { return (1024 + 8 * i) | 512u << 11 | 1024u << 21; }
    glm::dvec3 camera_m() const { return glm::dvec3(block_of_key(grid_, key(kCameraAt))) * 0.1; }
    void put(BlockStore& store, uint32_t i) {
        words_[i] = random_words(random_, 7);
        put_words(store, key(i), i, words_[i]);
    }
    void put_all(BlockStore& store) {
        for (uint32_t i = 0; i < kBlocks; ++i) {
            put(store, i);
            store.make_room(grid_, camera_m());
        }
    }
    void expect_all(const BlockStore& store) const {
        EXPECT_EQ(store.blocks(), words_.size());
        for (const auto& [i, words] : words_) {
            uint32_t stamp = 0;
            EXPECT_EQ(read(store, key(i), true, &stamp), words);
            EXPECT_EQ(stamp, i);
        }
    }

    std::mt19937 random_{11};
    gpu::VoxelGrid grid_ = [] {
        gpu::VoxelGrid grid{};
        grid.voxel_m = 0.0125f;  // blocks of 10 cm
        return grid;
    }();
    std::map<uint32_t, Words> words_;
};

TEST_F(BlockFileTest, HoldsWhatMemoryIsNotToHold) {
    const TemporaryPlace place;
    BlockStore store(kMostBytes);
    put_all(store);
    EXPECT_TRUE(place.holds_nothing()) << "the file has no name";
    EXPECT_LE(store.bytes_in_memory(), kMostBytes);
    EXPECT_GT(store.blocks_in_file(), kBlocks / 2);
    EXPECT_EQ(store.filed(), store.blocks_in_file());
    EXPECT_EQ(store.problem(), "");
    expect_all(store);
    // The farthest ones go first.
    const BlockStore::Kept kept = store.take(key(0));
    EXPECT_TRUE(kept.in_file);
    EXPECT_EQ(kept.packed.capacity(), 0u) << "its memory was given back";
    EXPECT_FALSE(store.take(key(kCameraAt)).in_file);
    words_.erase(0);
    words_.erase(kCameraAt);
    expect_all(store);

    BlockStore all(0);
    words_.clear();
    put_all(all);
    EXPECT_EQ(all.blocks_in_file(), 0u);
    EXPECT_GT(all.bytes_in_memory(), 2 * kMostBytes);
}

TEST_F(BlockFileTest, WhatComesBackAndLeavesAgainIsTheNewOne) {
    BlockStore store(kMostBytes);
    put_all(store);
    const uint32_t in_file = store.blocks_in_file();
    BlockStore::Kept kept = store.take(key(1));
    EXPECT_EQ(store.blocks_in_file(), in_file - 1);
    store.put(key(1), std::move(kept));
    EXPECT_EQ(store.blocks_in_file(), in_file);
    expect_all(store);

    const uint64_t bytes = store.bytes_in_memory();
    put(store, 1);  // replaces it
    EXPECT_EQ(store.blocks_in_file(), in_file - 1);
    EXPECT_GT(store.bytes_in_memory(), bytes);
    expect_all(store);
    put_all(store);
    expect_all(store);

    // Labels are replaced wherever the voxels are.
    std::vector<uint32_t> parents{0, 1, 1, 3, 4, 5, 6};
    for (uint32_t part = 0; part < gpu::kSweepParts; ++part) store.relabel(part, parents);
    for (auto& [i, words] : words_) {
        for (uint32_t& word : words.labels) word = (word & 0xffff) == 2 ? word - 1 : word;
    }
    expect_all(store);
    store.clear();
    EXPECT_EQ(store.bytes_in_memory() + store.blocks_in_file() + store.blocks(), 0u);
}

TEST_F(BlockFileTest, IsPartOfTheState) {
    BlockStore store(kMostBytes), other(kMostBytes);
    put_all(store);
    const uint32_t in_file = store.blocks_in_file();
    MemoryVisitor visitor(true);
    store.visit(visitor, grid_);
    EXPECT_EQ(store.blocks_in_file(), in_file) << "keeping it changes nothing";
    expect_all(store);
    visitor.reverse();
    other.visit(visitor, grid_);
    expect_all(other);
    EXPECT_LE(other.bytes_in_memory(), kMostBytes);
    EXPECT_GT(other.blocks_in_file(), 0u);
}

TEST_F(BlockFileTest, AFullDiskLeavesAllInMemoryAndSaysSo) {
    for (const rlim_t bytes : {0, 4096, 100 << 10}) {
        const TemporaryPlace place;
        BlockStore store(kMostBytes);
        {
            const test::FileSizeLimit limit(bytes);
            put_all(store);
            EXPECT_THAT(store.problem(), testing::HasSubstr("patina-blocks-"));
            EXPECT_GT(store.bytes_in_memory(), 2 * kMostBytes);
            expect_all(store);
        }
        EXPECT_TRUE(place.holds_nothing());
        // Where there is room again, it goes on.
        for (uint32_t i = kBlocks; i < kBlocks + 20; ++i) put(store, i);
        store.make_room(grid_, camera_m());
        EXPECT_EQ(store.problem(), "");
        EXPECT_LE(store.bytes_in_memory(), kMostBytes);
        expect_all(store);
        words_.clear();
    }
}

TEST_F(BlockFileTest, WhatWasWrittenStaysWhereTheDiskFillsUp) {
    BlockStore store(kMostBytes);
    for (uint32_t i = 0; i < kBlocks / 2; ++i) put(store, i);
    store.make_room(grid_, camera_m());
    const uint32_t in_file = store.blocks_in_file();
    EXPECT_GT(in_file, 0u);
    {
        const test::FileSizeLimit limit(in_file * 6400);
        for (uint32_t i = kBlocks / 2; i < kBlocks; ++i) put(store, i);
        store.make_room(grid_, camera_m());
        EXPECT_NE(store.problem(), "");
        expect_all(store);
    }
    // What comes back to the device takes the problem along.
    for (uint32_t i = 0; i < kBlocks; ++i) {
        if (store.bytes_in_memory() <= kMostBytes) break;
        store.take(key(i));
        words_.erase(i);
    }
    store.make_room(grid_, camera_m());
    EXPECT_EQ(store.problem(), "");
    expect_all(store);
}

TEST_F(BlockFileTest, AFolderThatIsNotThereIsNamed) {
    const TemporaryPlace place("/nowhere");
    BlockStore store(kMostBytes);
    put_all(store);
    EXPECT_THAT(store.problem(), testing::HasSubstr("'/nowhere/patina-blocks-"));
    expect_all(store);
}

TEST(StreamRegion, IsABallAndAConeThatGrowByAsMuch) {
    gpu::VoxelGrid grid{};
    grid.voxel_m = 0.0125f;  // blocks of 10 cm
    StreamRegion region = StreamRegion::ball({0.05, 0.05, 0.05}, 1);
    region.axis = {0, 0, 1};
    region.far_m = 3;
    region.half_angle = 0.5;
    const auto holds = [&](const StreamRegion& of, double x, double z) {
        return of.holds(grid, glm::ivec3(std::lround(10 * x), 0, std::lround(10 * z)));
    };
    EXPECT_TRUE(holds(region, -0.9, 0));
    EXPECT_FALSE(holds(region, -1.1, 0));
    EXPECT_TRUE(holds(region, 0, 2.9)) << "in the cone";
    EXPECT_FALSE(holds(region, 0, 3.1));
    EXPECT_FALSE(holds(region, 0, -1.1)) << "behind it";
    EXPECT_TRUE(holds(region, 2 * std::tan(0.45), 2));
    EXPECT_FALSE(holds(region, 2 * std::tan(0.55), 2));
    const StreamRegion more = region.grown(0.5);
    std::mt19937 random(9);
    std::uniform_real_distribution<double> within(-4, 4);
    uint32_t near = 0;
    for (int i = 0; i < 20000; ++i) {
        const auto anywhere = [&] { return glm::dvec3(within(random), within(random), within(random)); };
        const glm::ivec3 block(glm::round(10.0 * anywhere()));
        if (!region.holds(grid, block)) continue;
        const glm::ivec3 step(3.9 * glm::normalize(anywhere()));
        EXPECT_TRUE(more.holds(grid, block + step)) << "what is as near to it";
        ++near;
    }
    EXPECT_GT(near, 300u);
    EXPECT_FALSE(holds(more, 0, 3.7));
    EXPECT_FALSE(holds(more, 0, -1.6));
    EXPECT_FALSE(holds(more, 2.9, 0)) << "the cone does not open all round";
}

TEST(StreamRegion, HasItsMiddle) {
    gpu::VoxelGrid grid{};
    grid.voxel_m = 0.0125f;  // blocks of 10 cm
    EXPECT_EQ(StreamRegion::ball({1, 2, 3}, 4).middle_m(grid), glm::dvec3(1, 2, 3));
    EXPECT_LT(glm::distance(StreamRegion::box({0, 10, -20}, {9, 19, -1}).middle_m(grid), glm::dvec3(0.5, 1.5, -1)),
              1e-6);
}

TEST(StreamRegion, ACubeMeetsItWhereOneOfItsBlocksMay) {
    std::mt19937 random(8);
    gpu::VoxelGrid grid{};
    grid.voxel_m = 0.02f;
    uint32_t met = 0;
    for (int i = 0; i < 400; ++i) {
        const auto coordinate = [&] { return static_cast<int>(random() % 40) - 20; };
        const glm::ivec3 low(coordinate(), coordinate(), coordinate());
        const StreamRegion region =
            i % 2 == 0
                ? StreamRegion::ball(glm::dvec3(coordinate(), coordinate(), coordinate()) * 0.1, 0.2 + 0.1 * (i % 9))
                : StreamRegion::box({coordinate(), coordinate(), coordinate()}, {20, 20, 20});
        bool holds = false;
        for (int at = 0; at < 512; ++at)
            holds = holds || region.holds(grid, low + glm::ivec3(at & 7, at >> 3 & 7, at >> 6));
        EXPECT_TRUE(!holds || region.meets(grid, low, 8));
        met += region.meets(grid, low, 8) ? 1 : 0;
    }
    EXPECT_GT(met, 20u);
    EXPECT_LT(met, 300u) << "what is far is left out";
}

}  // namespace
}  // namespace patina::block_store_test
