#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "engine/graph/plan/plan.h"
#include "tests/graph/frame_builder.h"

namespace patina::graph::dump_test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr const char* kHardName = "a \"hard\" \\ name\n\x01";

Description make_frame() {
    FrameBuilder frame;
    const uint32_t depth = frame.image("depth", 64, 16);
    const uint32_t map = frame.import("map");
    const uint32_t debug = frame.buffer(kHardName, 8, 4);
    frame.pass("upload", {{depth, Use::kTransferWrite}})
        .pass("integrate", {{depth, Use::kSampled}, {map, Use::kStorageReadWrite}})
        .pass("debug", {{map, Use::kStorageRead}, {debug, Use::kStorageWrite}})
        .keep(map);
    return frame.description();
}

TEST(ToJson, HoldsTheWholeFrameAndPlan) {
    const Description description = make_frame();
    const json expected = json::parse(R"({
        "resources": [
            {"name": "depth", "kind": "image", "imported": false, "need": {"bytes": 64, "alignment": 16}},
            {"name": "map", "kind": "buffer", "imported": true, "need": null},
            {"name": "a \"hard\" \\ name\n\u0001", "kind": "buffer", "imported": false, "need": {"bytes": 8, "alignment": 4}}
        ],
        "passes": [
            {"name": "upload", "accesses": [{"resource": 0, "version": 0, "use": "transfer_write"}]},
            {"name": "integrate", "accesses": [{"resource": 0, "version": 1, "use": "sampled"},
                                               {"resource": 1, "version": 0, "use": "storage_read_write"}]},
            {"name": "debug", "accesses": [{"resource": 1, "version": 1, "use": "storage_read"},
                                           {"resource": 2, "version": 0, "use": "storage_write"}]}
        ],
        "kept": [{"resource": 1, "version": 1}],
        "order": [0, 1],
        "culled": [2],
        "lifetimes": [{"first": 0, "last": 1}, {"first": 1, "last": 1}, null],
        "placements": [{"offset": 0, "bytes": 64}, null, null],
        "barriers": [
            {"before": 0, "resource": null, "discard": false,
             "source": {"stages": ["compute", "transfer", "indirect"], "accesses": ["storage_write", "transfer_write"]},
             "destination": {"stages": ["compute", "transfer"],
                             "accesses": ["storage_read", "storage_write", "sampled_read", "transfer_write"]}},
            {"before": 0, "resource": 0, "discard": true,
             "source": {"stages": ["compute", "transfer", "indirect"], "accesses": ["storage_write", "transfer_write"]},
             "destination": {"stages": ["transfer"], "accesses": ["transfer_write"]}},
            {"before": 1, "resource": 0, "discard": false,
             "source": {"stages": ["transfer"], "accesses": ["transfer_write"]},
             "destination": {"stages": ["compute"], "accesses": ["sampled_read"]}}
        ],
        "buffer_arena": {"bytes": 0, "alignment": 1},
        "image_arena": {"bytes": 64, "alignment": 16}
    })");
    EXPECT_EQ(json::parse(to_json(description, compile(description))), expected);
}

TEST(ToJson, IsValidForAnEmptyFrame) { EXPECT_EQ(json::parse(to_json({}, {}))["order"], json::array()); }

TEST(ToDot, DrawsPassesVersionsAndBarriers) {
    const Description description = make_frame();
    const std::string dot = to_dot(description, compile(description));
    EXPECT_THAT(dot, HasSubstr("p1 [shape=box, style=solid, label=\"1 integrate\"];"));
    EXPECT_THAT(dot, HasSubstr("p2 [shape=box, style=dashed, label=\"debug\"];"));
    EXPECT_THAT(dot, HasSubstr("r0v1 [shape=ellipse, label=\"depth v1\"];"));
    EXPECT_THAT(dot, HasSubstr("r2v1 [shape=ellipse, label=\"a \\\"hard\\\" \\\\ name\\n\x01 v1\"];"));
    EXPECT_THAT(dot, HasSubstr("r0v1 -> p1 [style=solid, color=red, label=\"sampled\\n"
                               "transfer(transfer_write) -> compute(sampled_read)\"];"));
    EXPECT_THAT(dot, HasSubstr("p1 -> r1v1 [style=solid, label=\"storage_read_write\"];"));
    EXPECT_THAT(dot, HasSubstr("p2 -> r2v1 [style=dashed, label=\"storage_write\"];"));
    EXPECT_THAT(dot, HasSubstr("boundary -> p0 [color=red, label="));
    EXPECT_THAT(dot, HasSubstr("-> transfer(transfer_write), discard\"];"));
}

}  // namespace
}  // namespace patina::graph::dump_test
