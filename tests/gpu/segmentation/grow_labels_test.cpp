#include "passes/segmentation/grow_labels.h"

#include <numeric>

#include "engine/graph/enlargement.h"
#include "tests/gpu/gpu_test.h"

namespace patina::grow_labels_test {
namespace {

/// A ring of free labels: `free` of them from `head` on.
struct Ring {
    uint32_t head, free;
};

class GrowLabelsTest : public GpuTest {
  protected:
    static constexpr uint32_t kBefore = 200;

    /// The labels of a ring in order, before it grows to `after` labels and after that.
    std::pair<std::vector<uint32_t>, std::vector<uint32_t>> grown(Ring ring, uint32_t after) {
        SegmentTable table(device(), kBefore);
        graph::FrameGraph start = runner().begin();
        table.reset(start);
        run(std::move(start));
        std::vector<uint32_t> words(kBefore);
        std::iota(words.begin(), words.end(), 1000u);
        gpu::SegmentCounters counters{};
        counters.capacity = kBefore;
        counters.free_head = ring.head;
        counters.free_labels = ring.free;
        graph::Enlargement enlargement(device());
        graph::FrameGraph fill = runner().begin();
        const SegmentTableIds before = table.import(fill);
        fill.keep(fill.upload_bytes(before.free_labels, 0, std::as_bytes(std::span(words)), true));
        fill.keep(fill.upload_bytes(before.counters, 0, std::as_bytes(std::span(&counters, 1)), true));
        run(std::move(fill));

        table.enlarge(enlargement, after);
        enlargement.allocate();
        graph::FrameGraph frame = runner().begin();
        enlargement.commit(frame);
        SegmentTableIds ids = table.import(frame);
        add_grow_labels(frame, table, ids, kBefore);
        SegmentTable::keep(frame, ids);
        enlargement.keep(frame);
        const graph::Readback ring_read = frame.read_back(ids.free_labels), counted = frame.read_back(ids.counters),
                              parents = frame.read_back(ids.parents);
        run(std::move(frame));
        enlargement.accept();

        EXPECT_EQ(table.capacity(), after);
        const auto now = counted.as<gpu::SegmentCounters>().front();
        EXPECT_EQ(now.capacity, after);
        const std::vector<uint32_t> known = parents.as<uint32_t>();
        EXPECT_EQ(std::accumulate(known.begin(), known.end(), 0u), 0u) << "no new label is in use";
        std::vector<uint32_t> expected, got;
        for (uint32_t i = 0; i < ring.free; ++i) expected.push_back(words[(ring.head + i) % kBefore]);
        for (uint32_t label = kBefore; label < after; ++label) expected.push_back(label);
        const std::vector<uint32_t> larger = ring_read.as<uint32_t>();
        for (uint32_t i = 0; i < now.free_labels; ++i) got.push_back(larger[(now.free_head + i) % after]);
        return {expected, got};
    }
};

TEST_F(GrowLabelsTest, NewLabelsStandBehindThoseThatWereFreeBefore) {
    const Ring rings[] = {{0, 199}, {0, 0}, {199, 0}, {30, 100}, {150, 49}, {150, 50}, {150, 190}, {199, 199}};
    for (const uint32_t after : {201u, 230u, 264u, 400u, 3000u}) {
        for (const Ring& ring : rings) {
            SCOPED_TRACE(text(ring.free, " free from ", ring.head, " on, ", after, " labels"));
            const auto [expected, got] = grown(ring, after);
            EXPECT_EQ(got, expected);
        }
    }
}

}  // namespace
}  // namespace patina::grow_labels_test
