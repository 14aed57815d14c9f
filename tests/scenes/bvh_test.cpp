#include "scenes/render/bvh.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace patina::scenes::bvh_test {
namespace {

constexpr uint32_t kMaxLeaf = 4;

Bounds box(glm::vec3 low, glm::vec3 size) { return {low, low + size}; }

std::vector<Bounds> random_boxes(size_t count) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> position(-3, 3), size(0, 0.2f);
    std::vector<Bounds> boxes;
    for (size_t i = 0; i < count; ++i) {
        const glm::vec3 low(position(random), position(random), position(random));
        boxes.push_back(box(low, {size(random), size(random), size(random)}));
    }
    return boxes;
}

/// Sets of boxes that builders stumble over, and ordinary ones.
std::vector<std::pair<std::string, std::vector<Bounds>>> box_sets() {
    std::vector<Bounds> exponential, grid;
    for (int i = 0; i < 120; ++i) exponential.push_back(box(glm::vec3(std::ldexp(1.0f, i - 60)), glm::vec3(0)));
    for (int i = 0; i < 100; ++i) grid.push_back(box(glm::vec3(i % 10, 0, i / 10), glm::vec3(1, 0, 1)));
    return {{"none", {}},
            {"one", random_boxes(1)},
            {"five", random_boxes(5)},
            {"thousand", random_boxes(1000)},
            {"flat grid", grid},
            {"all the same", std::vector<Bounds>(37, box(glm::vec3(1), glm::vec3(2)))},
            {"the same point", std::vector<Bounds>(37, box(glm::vec3(1), glm::vec3(0)))},
            {"exponential", exponential},
            {"huge", {box(glm::vec3(-2e38f), glm::vec3(1e38f)), box(glm::vec3(1e38f), glm::vec3(1e38f))}}};
}

TEST(Bvh, BoundsHoldTheChildrenAndLeavesHoldEveryPrimitiveOnce) {
    for (const auto& [name, boxes] : box_sets()) {
        SCOPED_TRACE(name);
        const Bvh bvh = build_bvh(boxes, kMaxLeaf);
        std::vector<int> times(boxes.size());
        for (const Bvh::Node& node : bvh.nodes) {
            EXPECT_LE(node.count, kMaxLeaf);
            for (uint32_t i = node.first; i < node.first + node.count; ++i) {
                ++times.at(bvh.primitives[i]);
                EXPECT_TRUE(node.bounds.contains(boxes[bvh.primitives[i]]));
            }
            if (node.count > 0) continue;
            EXPECT_TRUE(node.bounds.contains(bvh.nodes.at(node.lower).bounds));
            EXPECT_TRUE(node.bounds.contains(bvh.nodes.at(node.upper).bounds));
        }
        EXPECT_THAT(times, ::testing::Each(1));
        EXPECT_EQ(bvh.nodes.empty(), boxes.empty());
    }
}

/// Counts which leaves a walk meets that enters the boxes for which `enter` says so.
template <class Enter>
std::vector<uint32_t> walk(const std::vector<ThreadedNode>& list, Enter enter) {
    std::vector<uint32_t> firsts;
    for (uint32_t i = 0; i < list.size();) {
        const bool entered = enter(list[i].bounds);
        if (entered && list[i].count > 0) firsts.push_back(list[i].first);
        const uint32_t next = entered ? i + 1 : list[i].skip;
        EXPECT_GT(next, i) << "a walk must go forward";
        EXPECT_LE(next, list.size());
        i = next;
    }
    return firsts;
}

TEST(Bvh, EveryOrderVisitsAllLeavesOnceAndSkipsWholeSubtrees) {
    for (const auto& [name, boxes] : box_sets()) {
        const Bvh bvh = build_bvh(boxes, kMaxLeaf);
        std::vector<uint32_t> all;
        for (const Bvh::Node& node : bvh.nodes)
            if (node.count > 0) all.push_back(node.first);
        for (uint32_t octant = 0; octant < 8; ++octant) {
            SCOPED_TRACE(name + ", octant " + std::to_string(octant));
            const auto list = thread_bvh(bvh, octant);
            EXPECT_EQ(list.size(), bvh.nodes.size());
            EXPECT_THAT(walk(list, [](const Bounds&) { return true; }), ::testing::UnorderedElementsAreArray(all));
            EXPECT_THAT(walk(list, [](const Bounds&) { return false; }), ::testing::IsEmpty());
            // Skipping every box that a point is outside of must leave all the leaves that hold it.
            for (const Bounds& target : boxes) {
                const auto holds = [&](const Bounds& b) { return b.contains({target.low, target.low}); };
                size_t expected = 0;
                for (const Bvh::Node& node : bvh.nodes) expected += node.count > 0 && holds(node.bounds);
                ASSERT_EQ(walk(list, holds).size(), expected);
            }
        }
    }
}

TEST(Bvh, EachOctantMeetsTheNearerChildFirst) {
    const std::vector<Bounds> boxes{box({0, 0, 0}, glm::vec3(0.1f)), box({5, 0, 0}, glm::vec3(0.1f))};
    const Bvh bvh = build_bvh(boxes, 1);
    for (uint32_t octant = 0; octant < 8; ++octant) {
        const auto list = thread_bvh(bvh, octant);
        ASSERT_EQ(list.size(), 3u);
        const bool leftward = (octant & 1) != 0;
        EXPECT_EQ(list[1].bounds, boxes[leftward ? 1 : 0]) << octant;
    }
}

TEST(Bvh, SameBoxesGiveTheSameTree) {
    const auto boxes = random_boxes(1000);
    const Bvh first = build_bvh(boxes, kMaxLeaf), second = build_bvh(boxes, kMaxLeaf);
    EXPECT_EQ(first.primitives, second.primitives);
    ASSERT_EQ(first.nodes.size(), second.nodes.size());
    for (size_t i = 0; i < first.nodes.size(); ++i) {
        EXPECT_EQ(first.nodes[i].bounds, second.nodes[i].bounds);
        EXPECT_EQ(first.nodes[i].first, second.nodes[i].first);
    }
}

TEST(Bvh, SeparatesClustersSoThatFewBoxesAreMet) {
    const auto boxes = random_boxes(4000);
    const Bvh bvh = build_bvh(boxes, kMaxLeaf);
    const auto list = thread_bvh(bvh, 0);
    size_t visited = 0;
    for (const Bounds& target : boxes)
        walk(list, [&](const Bounds& b) { return ++visited, b.contains({target.low, target.low}); });
    EXPECT_LT(static_cast<double>(visited) / boxes.size(), 100) << "nodes met per point, of " << list.size();
}

}  // namespace
}  // namespace patina::scenes::bvh_test
