#include "passes/segmentation/segment_frame.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <numeric>
#include <random>

#include <glm/gtc/packing.hpp>

#include "engine/core/shader_camera.h"
#include "passes/segmentation/label_components.h"
#include "passes/segmentation/number_segments.h"
#include "tests/gpu/gpu_test.h"
#include "tests/gpu/input/input_pictures.h"
#include "tests/reference/scenes/analytic_scene.h"
#include "tests/reference/segmentation/frame_segments.h"

namespace patina::segment_frame_test {
namespace {

using reference::DistanceField;

const RigidTransform kPose = reference::look_at({0.1, -0.5, -1.0}, {0, 0.4, 0.6});
constexpr Extent2D kExtent{320, 240};

/// World y points down; the floor is at y = 0.6.
DistanceField with_floor(const DistanceField& object) {
    return [floor = reference::half_space({0, -1, 0}, -0.6), object](glm::dvec3 p) {
        return std::min(floor(p), object(p));
    };
}

DistanceField box_on_floor() { return with_floor(reference::box({0, 0.5, 0.6}, {0.15, 0.1, 0.1})); }

Image<float> rendered(const DistanceField& field, Extent2D extent = kExtent) {
    return reference::render_depth(field, pinhole_camera(extent), kPose, 5);
}

/// As a Kinect v2 measures it.
Image<float> noisy(Image<float> depth_m, uint32_t seed) {
    std::mt19937 random(seed);
    std::normal_distribution<float> normal;
    for (float& z : depth_m.pixels()) {
        if (z > 0) z += (0.001f + 0.00025f * z * z) * normal(random);
    }
    return depth_m;
}

class SegmentFrame : public GpuTest {
  protected:
    struct Result {
        Image<uint32_t> segment;
        std::vector<gpu::FrameSegment> segments;
        gpu::FrameSegmentCount count{};
    };

    template <class Pixel>
    graph::ImageId upload(graph::FrameGraph& frame, const char* name, const Image<Pixel>& image,
                          vulkan::Format format) {
        return frame.upload(name, {image.extent(), format}, std::as_bytes(std::span(image.pixels())));
    }

    Result finish(graph::FrameGraph frame, const FrameSegments& out) {
        const graph::Readback segment = frame.read_back(out.segment), segments = frame.read_back(out.segments),
                              count = frame.read_back(out.count);
        run(std::move(frame));
        return {segment.image<uint32_t>(), segments.as<gpu::FrameSegment>(),
                count.as<gpu::FrameSegmentCount>().front()};
    }

    using Colors = Image<std::array<float, 4>>;

    Result segment(const Image<float>& model_m, const Image<float>& reading_m, const SegmentSettings& settings = {},
                   const Colors& colors = Colors({1, 1})) {
        Image<glm::vec4> model(model_m.extent());
        for (size_t i = 0; i < model.pixels().size(); ++i) model.pixels()[i].w = model_m.pixels()[i];
        graph::FrameGraph frame = runner().begin();
        const auto model_id = upload(frame, "model", model, vulkan::Format::kRgba32f);
        const auto reading_id = upload(frame, "reading", reading_m, vulkan::Format::kR32f);
        Image<uint64_t> halves(colors.extent());
        for (size_t i = 0; i < halves.pixels().size(); ++i) {
            const auto& [r, g, b, a] = colors.pixels()[i];
            halves.pixels()[i] = glm::packHalf4x16({r, g, b, a});
        }
        const auto color_id = upload(frame, "color", halves, vulkan::Format::kRgba16f);
        const gpu::Camera camera = make_camera(pinhole_camera(model_m.extent()), kPose);
        const FrameSegments out = add_segment_frame(frame, model_id, reading_id, camera, {color_id, camera}, settings);
        return finish(std::move(frame), out);
    }
    Result segment(const Image<float>& depth_m, const SegmentSettings& settings = {}) {
        return segment(depth_m, Image<float>(depth_m.extent()), settings);
    }

    Result given(const Image<uint32_t>& ids, const Image<float>& depth_m, uint32_t capacity) {
        graph::FrameGraph frame = runner().begin();
        const auto id = upload(frame, "ids", ids, vulkan::Format::kR32u);
        const auto depth = upload(frame, "depth_m", depth_m, vulkan::Format::kR32f);
        return finish(std::move(frame), add_given_segments(frame, id, depth, capacity));
    }

    /// The components of all pixels with depth, numbered.
    Result number(const Image<float>& depth_m, uint32_t min_pixels, uint32_t capacity) {
        graph::FrameGraph frame = runner().begin();
        const auto depth = upload(frame, "depth_m", depth_m, vulkan::Format::kR32f);
        const Components found = add_label_components(frame, depth, 0.01f, 0.015f);
        return finish(std::move(frame),
                      add_number_segments(frame, found.pixels, found.component, depth, min_pixels, capacity));
    }

    static void expect_same(const Result& got, const reference::Segments& expected) {
        EXPECT_TRUE(got.segment.pixels() == expected.number.pixels());
        EXPECT_EQ(got.count.segments, expected.segments.size() - 1);
        EXPECT_EQ(got.count.too_small, expected.too_small);
        EXPECT_EQ(got.count.beyond_capacity, expected.beyond_capacity);
        for (size_t i = 0; i < got.segments.size(); ++i) {
            const gpu::FrameSegment& g = got.segments[i];
            if (i == 0 || i >= expected.segments.size()) {
                ASSERT_EQ(g.pixels, 0u) << i;
                continue;
            }
            const reference::Segment& e = expected.segments[i];
            ASSERT_EQ(g.pixels, e.pixels) << i;
            ASSERT_EQ(g.key, e.key) << i;
            ASSERT_EQ(g.touches_border != 0, e.touches_border) << i;
        }
    }

    /// How many segments a picture has, and the share of its pixels with depth that the largest `n` hold.
    static double share_of_largest(const Result& result, const Image<float>& depth_m, size_t n) {
        std::vector<uint32_t> sizes;
        for (const auto& segment : result.segments) sizes.push_back(segment.pixels);
        std::sort(sizes.rbegin(), sizes.rend());
        const auto known =
            std::count_if(depth_m.pixels().begin(), depth_m.pixels().end(), [](float z) { return z > 0; });
        return std::accumulate(sizes.begin(), sizes.begin() + static_cast<long>(n), 0.0) / static_cast<double>(known);
    }
};

TEST_F(SegmentFrame, NumberedComponentsEqualTheReference) {
    for (const Extent2D extent : {Extent2D{1, 1}, {33, 17}, {131, 65}, {512, 424}}) {
        const Image<float> depth_m = random_depth(extent, 9);
        const Image<uint32_t> key = reference::components(depth_m);
        for (const auto& [min_pixels, capacity] : {std::pair(1u, 4095u), {20u, 4095u}, {4u, 30u}}) {
            SCOPED_TRACE(::testing::Message() << extent << ", " << min_pixels << " px, room for " << capacity);
            expect_same(number(depth_m, min_pixels, capacity),
                        reference::number_segments(key, depth_m, min_pixels, capacity));
        }
    }
}

TEST_F(SegmentFrame, AChequerboardFillsTheTableAndTheRestIsCounted) {
    Image<float> depth_m({512, 424});
    for (uint32_t y = 0; y < 424; ++y) {
        for (uint32_t x = 0; x < 512; ++x) depth_m.at(x, y) = (x + y) % 2 == 0 ? 1.0f : 0.0f;
    }
    const Result got = number(depth_m, 1, 4095);
    EXPECT_EQ(got.count.segments, 4095u);
    EXPECT_EQ(got.count.beyond_capacity, 512u * 424 / 2 - 4095);
    EXPECT_EQ(got.segment.at(0, 0), 1u);
    EXPECT_EQ(got.segment.at(508, 15), 0u);
    EXPECT_EQ(number(depth_m, 2, 4095).count.too_small, 512u * 424 / 2);
}

TEST_F(SegmentFrame, GivenIdsAreKeptAndUnknownOnesLeftOut) {
    const Extent2D extent{131, 65};
    const Image<float> depth_m = random_depth(extent, 4);
    const std::array<uint32_t, 6> ids{0, 1, 7, 300, 65535, 65536};
    std::mt19937 random(3);
    Image<uint32_t> picture(extent), known(extent);
    for (size_t i = 0; i < extent.area(); ++i) {
        picture.pixels()[i] = ids[(i / 9 + random() % 2) % ids.size()];
        known.pixels()[i] = picture.pixels()[i] == 65536 ? 0 : picture.pixels()[i];
    }
    for (const uint32_t capacity : {4095u, 3u}) {
        expect_same(given(picture, depth_m, capacity), reference::number_segments(known, depth_m, 1, capacity));
    }
}

TEST_F(SegmentFrame, ABoxOnTheFloorIsOneSegmentAndTheFloorAnother) {
    const Image<float> depth_m = rendered(box_on_floor());
    const Result got = segment(depth_m);
    EXPECT_EQ(got.count.segments, 2u);
    EXPECT_GT(share_of_largest(got, depth_m, 2), 0.995);
    // The box, three of whose faces are seen, is not split at their edges; the floor stays out of it.
    const Intrinsics camera = pinhole_camera(kExtent);
    size_t wrong = 0;
    for (uint32_t y = 0; y < kExtent.height; ++y) {
        for (uint32_t x = 0; x < kExtent.width; ++x) {
            const double z = depth_m.at(x, y);
            if (z <= 0) continue;
            const glm::dvec4 point_m(glm::dvec3((x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, 1) * z, 1);
            const double height_m = 0.6 - glm::dvec3(kPose * point_m).y;
            const uint32_t own = got.segment.at(x, y);
            const gpu::FrameSegment& s = got.segments[own];
            wrong += own != 0 && (s.touches_border != 0) != (height_m < 0.002);
        }
    }
    EXPECT_LT(wrong, kExtent.area() / 500);
}

TEST_F(SegmentFrame, ASphereOnTheFloorAndTwoBoxesBesideEachOther) {
    const Image<float> ball = rendered(with_floor(reference::sphere({0, 0.45, 0.6}, 0.15)));
    EXPECT_EQ(segment(ball).count.segments, 2u);
    const DistanceField pair = [a = reference::box({-0.12, 0.5, 0.6}, {0.1, 0.1, 0.1}),
                                b = reference::box({0.12, 0.5, 0.7}, {0.1, 0.1, 0.1})](glm::dvec3 p) {
        return std::min(a(p), b(p));
    };
    EXPECT_EQ(segment(rendered(with_floor(pair))).count.segments, 3u);
}

TEST_F(SegmentFrame, PartsOfOneStrongColourAreOneSegmentAcrossTheirCreases) {
    // A box before a higher one: they meet in concave creases.
    const DistanceField field = [a = reference::box({-0.12, 0.5, 0.6}, {0.1, 0.1, 0.1}),
                                 b = reference::box({0.12, 0.42, 0.7}, {0.14, 0.18, 0.1})](glm::dvec3 p) {
        return std::min(a(p), b(p));
    };
    const Image<float> depth_m = rendered(field), nothing(depth_m.extent());
    const Intrinsics camera = pinhole_camera(kExtent);
    const auto painted = [&](std::array<float, 4> left, std::array<float, 4> right) {
        Colors colors(kExtent);
        for (uint32_t y = 0; y < kExtent.height; ++y) {
            for (uint32_t x = 0; x < kExtent.width; ++x) {
                const double z = depth_m.at(x, y);
                const glm::dvec4 point_m(glm::dvec3((x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, 1) * z,
                                         1);
                colors.at(x, y) = glm::dvec3(kPose * point_m).x < -0.02 ? left : right;
            }
        }
        return segment(depth_m, nothing, {}, colors).count.segments;
    };
    EXPECT_EQ(painted({0.3f, 0.3f, 0.3f, 1}, {0.3f, 0.3f, 0.3f, 1}), 2u) << "grey says nothing";
    EXPECT_EQ(painted({0.6f, 0.2f, 0.1f, 1}, {0.6f, 0.2f, 0.1f, 1}), 1u);
    EXPECT_EQ(painted({0.6f, 0.2f, 0.1f, 1}, {0.65f, 0.25f, 0.15f, 1}), 1u) << "paler by a highlight";
    EXPECT_EQ(painted({0.6f, 0.2f, 0.1f, 1}, {0.6f, 0.1f, 0.2f, 1}), 2u) << "another hue";
}

TEST_F(SegmentFrame, NoiseDoesNotSplitThem) {
    const Image<float> exact_m = rendered(box_on_floor());
    const Result exact = segment(exact_m);
    const double box = share_of_largest(exact, exact_m, 2) - share_of_largest(exact, exact_m, 1);
    for (uint32_t seed = 0; seed < 3; ++seed) {
        const Image<float> depth_m = noisy(exact_m, seed);
        const Result got = segment(depth_m);
        EXPECT_GT(share_of_largest(got, depth_m, 2), 0.98);
        EXPECT_NEAR(share_of_largest(got, depth_m, 2) - share_of_largest(got, depth_m, 1), box, 0.1 * box);
    }
}

/// Of every second pixel the parts are the same, but for what lies between two of those that are looked at.
TEST_F(SegmentFrame, EverySecondPixelShowsTheSameParts) {
    const SegmentSettings half{.stride_px = 2};
    for (const Extent2D extent : {kExtent, Extent2D{319, 241}}) {
        const Image<float> exact_m = rendered(box_on_floor(), extent);
        for (const Image<float>& depth_m : {exact_m, noisy(exact_m, 2)}) {
            const Result full = segment(depth_m), got = segment(depth_m, half);
            ASSERT_EQ(got.segment.extent(), (Extent2D{(extent.width + 1) / 2, (extent.height + 1) / 2}));
            EXPECT_EQ(got.count.segments, 2u);
            size_t differ = 0, known = 0;
            for (uint32_t y = 0; y < got.segment.extent().height; ++y) {
                for (uint32_t x = 0; x < got.segment.extent().width; ++x) {
                    known += got.segment.at(x, y) != 0 ? 1 : 0;
                    differ += got.segment.at(x, y) != full.segment.at(2 * x, 2 * y) ? 1 : 0;
                }
            }
            EXPECT_LT(differ, known / 40);
            EXPECT_EQ(got.segments[1].pixels + got.segments[2].pixels, 4 * known);
        }
    }
    SegmentSettings large = half;
    large.min_pixels = kExtent.width * kExtent.height / 2;
    EXPECT_EQ(segment(rendered(box_on_floor()), large).count.segments, 1u) << "settings count all pixels";
}

TEST_F(SegmentFrame, ReadingsStandInWhereThereIsNoModel) {
    const Image<float> depth_m = rendered(box_on_floor());
    Image<float> model_m = depth_m, reading_m(depth_m.extent());
    for (uint32_t y = 0; y < kExtent.height; ++y) {
        for (uint32_t x = 0; x < kExtent.width; ++x) {
            const bool known = x < kExtent.width / 2;  // half by the model, half by readings
            reading_m.at(x, y) = known && depth_m.at(x, y) > 0 ? 0.4f : depth_m.at(x, y);
            if (!known) model_m.at(x, y) = 0;
        }
    }
    EXPECT_TRUE(segment(model_m, reading_m).segment.pixels() == segment(depth_m).segment.pixels());
}

TEST_F(SegmentFrame, NoDepthAndNothingButEdgesHaveNoSegments) {
    EXPECT_EQ(segment(Image<float>(kExtent)).count.segments, 0u);
    Image<float> spikes(kExtent);
    for (size_t i = 0; i < spikes.pixels().size(); ++i) spikes.pixels()[i] = 0.6f + 0.5f * static_cast<float>(i % 7);
    const Result got = segment(spikes);
    EXPECT_EQ(got.count.segments, 0u);
    EXPECT_EQ(std::accumulate(got.segment.pixels().begin(), got.segment.pixels().end(), 0u), 0u);
}

TEST_F(SegmentFrame, APlaneIsOneSegmentThatHoldsEveryPixel) {
    for (const Extent2D extent : {Extent2D{16, 16}, {65, 33}, {320, 240}}) {
        const glm::dvec3 normal = glm::normalize(glm::dvec3(0.2, -0.15, -1));
        const Image<float> depth_m = reference::render_depth(reference::half_space(normal, normal.z * 1.5),
                                                             pinhole_camera(extent), RigidTransform(1.0), 5);
        const Result got = segment(depth_m);
        EXPECT_EQ(got.count.segments, 1u);
        for (size_t i = 0; i < extent.area(); ++i) {
            ASSERT_EQ(got.segment.pixels()[i], depth_m.pixels()[i] > 0 ? 1u : 0u) << extent << ' ' << i;
        }
    }
    EXPECT_EQ(segment(Image<float>({1, 1}, 1.0f), {.min_pixels = 1}).count.segments, 0u);
}

TEST_F(SegmentFrame, TheSameBytesEveryTime) {
    const Image<float> depth_m = noisy(rendered(box_on_floor()), 1);
    const Result first = segment(depth_m);
    for (int i = 0; i < 10; ++i) {
        const Result again = segment(depth_m);
        ASSERT_TRUE(again.segment.pixels() == first.segment.pixels());
        ASSERT_EQ(0, std::memcmp(again.segments.data(), first.segments.data(),
                                 first.segments.size() * sizeof(gpu::FrameSegment)));
    }
}

TEST_F(SegmentFrame, SettingsOutOfRangeAreErrors) {
    const auto message_of = [&](const SegmentSettings& settings) {
        try {
            segment(Image<float>({8, 8}), settings);
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string("none");
    };
    EXPECT_THAT(message_of({.min_pixels = 0}), ::testing::HasSubstr("0 px"));
    EXPECT_THAT(message_of({.capacity = 4096}), ::testing::HasSubstr("4096"));
    SegmentSettings reach;
    reach.edges.min_reach_px = 5;
    EXPECT_THAT(message_of(reach), ::testing::HasSubstr("from 5 to 4 px"));
}

}  // namespace
}  // namespace patina::segment_frame_test
