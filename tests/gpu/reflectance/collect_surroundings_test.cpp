// What is around, in cells.

#include "passes/reflectance/collect_surroundings.h"

#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <tuple>

#include "engine/core/octahedral.h"
#include "shared/fusion/voxel_map.h"
#include "tests/gpu/gpu_test.h"
#include "tests/gpu/reflectance/occupancy_bits.h"
#include "tests/gpu/reflectance/surroundings_inputs.h"
#include "tests/reference/reflectance/octahedral_texel.h"
#include "tests/reference/scenes/analytic_scene.h"

namespace patina::collect_surroundings_test {
namespace {

const Intrinsics kCamera{{96, 80}, 60, 60, 47.5, 39.5, {}};

using Cell = std::tuple<int, int, int>;

/// A plane that a camera sees at an angle, with a window in it.
struct Room {
    RigidTransform world_from_camera = reference::look_at({0.3, 0.2, 0}, {0.4, 0.1, 1});
    glm::dvec3 normal = glm::normalize(glm::dvec3(0.3, 0.2, -1));  ///< of the plane, in camera coordinates
    double offset_m = -2;                                          ///< of the plane along it
    Image<float> depth_m{kCamera.extent, 0.0f};
    Image<glm::vec4> color{kCamera.extent, glm::vec4(0)};

    Room() {
        for (uint32_t y = 0; y < kCamera.extent.height; ++y) {
            for (uint32_t x = 0; x < kCamera.extent.width; ++x) {
                depth_m.at(x, y) = static_cast<float>(plane_depth_m(x, y));
                color.at(x, y) = glm::vec4(static_cast<float>(x) / 64, static_cast<float>(y) / 64, 7, 1);
            }
        }
    }

    glm::dvec3 ray(double x, double y) const {
        return {(x - kCamera.cx) / kCamera.fx, (y - kCamera.cy) / kCamera.fy, 1};
    }
    double plane_depth_m(double x, double y) const { return offset_m / glm::dot(normal, ray(x, y)); }

    Cell cell(double x, double y) const {
        const glm::dvec3 point_m = glm::dvec3(world_from_camera * glm::dvec4(ray(x, y) * plane_depth_m(x, y), 1));
        const auto at = [](double v) { return static_cast<int>(std::floor(v / double{gpu::kSurroundingsCellM})); };
        return {at(point_m.x), at(point_m.y), at(point_m.z)};
    }

    void open(uint32_t x0, uint32_t x1, uint32_t y0, uint32_t y1) {
        for (uint32_t y = y0; y < y1; ++y) {
            for (uint32_t x = x0; x < x1; ++x) depth_m.at(x, y) = 0;
        }
    }
};

struct Sums {
    uint64_t samples = 0;
    glm::dvec3 color{0};
};
using Cells = std::map<Cell, Sums>;

class CollectSurroundingsTest : public GpuTest {
  protected:
    gpu::SurroundingsCounts counts{};         ///< after the last collect()
    std::vector<gpu::OpeningTexel> openings;  ///< likewise
    std::map<Cell, uint64_t> of_openings;     ///< likewise: samples without depth

    /// All 16 phases of a frame, so that every pixel looks once. `before`: how full the table is said to be. `settles`:
    /// then frames without colours, in which every direction has its turn.
    Cells collect(const Room& room, float radiance_scale = 0, const gpu::SurroundingsCounts& before = {},
                  bool settles = false) {
        graph::FrameGraph frame = runner().begin();
        ReflectanceStateIds state;
        state.surroundings = frame.fill(frame.create_buffer("surroundings", kSurroundingsBytes), 0);
        state.surroundings =
            frame.upload_bytes(state.surroundings, kSurroundingsCountsAt, std::as_bytes(std::span(&before, 1)), false);
        SurroundingsInputs inputs =
            upload_surroundings(frame, kCamera, room.world_from_camera, room.depth_m, room.color);
        inputs.radiance_scale = radiance_scale;
        inputs.lamp_luminance = 0.5f;
        for (inputs.frame_index = 0; inputs.frame_index < 16; ++inputs.frame_index)
            add_collect_surroundings(frame, state, inputs);
        inputs.color_linear =
            upload_surroundings(frame, kCamera, room.world_from_camera, room.depth_m, Image<glm::vec4>(kCamera.extent))
                .color_linear;
        for (; settles && inputs.frame_index < 16 + gpu::kOpeningTurns; ++inputs.frame_index)
            add_collect_surroundings(frame, state, inputs);
        const graph::Readback read = frame.read_back(state.surroundings);
        run(std::move(frame));
        Cells cells;
        std::vector<gpu::SurroundingsCell> all(gpu::kSurroundingsCells);
        const std::vector<std::byte> bytes = read.as<std::byte>();
        openings.resize(gpu::kOpeningTexels);
        std::memcpy(openings.data(), bytes.data() + kOpeningsAt, openings.size() * sizeof(openings[0]));
        std::memcpy(&counts, bytes.data() + kSurroundingsCountsAt, sizeof(counts));
        std::vector<uint32_t> words(sizeof(gpu::Occupancy) / sizeof(uint32_t));
        std::memcpy(words.data(), bytes.data() + kCellsInUseAt, sizeof(gpu::Occupancy));
        OccupancyBits in_use;
        std::memcpy(all.data(), bytes.data() + kSurroundingsCellsAt, all.size() * sizeof(all[0]));
        for (const gpu::SurroundingsCell& cell : all) {
            if (cell.key == 0) continue;
            const auto coordinate = [&](uint32_t shift) {
                const auto low = static_cast<int>(cell.key >> shift & 1023u);
                return low >= 512 ? low - 1024 : low;
            };
            in_use.add({coordinate(0), coordinate(10), coordinate(20)});
            Sums& sums = cells[{coordinate(0), coordinate(10), coordinate(20)}];
            EXPECT_EQ(sums.samples, 0u) << "a cell has one place";
            const gpu::SurroundingsSums& taken = radiance_scale > 0 ? cell.light.low : cell.light.usual;
            EXPECT_EQ((radiance_scale > 0 ? cell.light.usual : cell.light.low).samples, 0u);
            of_openings[{coordinate(0), coordinate(10), coordinate(20)}] = cell.openings;
            sums = {taken.samples, glm::dvec3(taken.r, taken.g, taken.b) / double{gpu::kSurroundingsSteps}};
        }
        const OccupancyBits marked(words);
        EXPECT_EQ(marked.cubes, in_use.cubes) << "rays would cross cells, or look at cubes without any";
        EXPECT_EQ(marked.cells, in_use.cells);
        return cells;
    }

    /// The same by a plain loop over the pixels for which `shows(x, y)` holds.
    template <class Shows>
    static Cells expected(const Room& room, Shows&& shows) {
        Cells cells;
        for (uint32_t y = 0; y < kCamera.extent.height; ++y) {
            for (uint32_t x = 0; x < kCamera.extent.width; ++x) {
                const glm::vec4 seen = glm::min(room.color.at(x, y), glm::vec4(gpu::kSurroundingsRange));
                if (!shows(x, y) || seen.a == 0) continue;
                Sums& sums = cells[room.cell(x, y)];
                ++sums.samples;
                sums.color += glm::dvec3(seen);
            }
        }
        return cells;
    }

    /// Pixels on the borders of cells may fall to either side in float: `most_apart` of them do.
    static void expect_same(const Cells& found, const Cells& wanted, uint64_t most_apart) {
        uint64_t apart = 0, pixels = 0;
        for (const auto& [cell, sums] : wanted) {
            const auto at = found.find(cell);
            const Sums got = at == found.end() ? Sums{} : at->second;
            apart += got.samples > sums.samples ? got.samples - sums.samples : sums.samples - got.samples;
            pixels += sums.samples;
            if (got.samples != sums.samples) continue;
            // Half floats and whole steps: less than a step a pixel.
            EXPECT_LT(glm::length(got.color - sums.color), 0.004 * static_cast<double>(sums.samples) + 1e-6);
        }
        uint64_t all = 0;
        for (const auto& [cell, sums] : found) all += sums.samples;
        EXPECT_EQ(all, pixels);
        EXPECT_LE(apart, most_apart);
    }
};

constexpr uint64_t kOnBorders = 40;  // of 7680 pixels

TEST_F(CollectSurroundingsTest, EveryPixelCountsOnceInTheCellOfItsSurface) {
    const Room room;
    expect_same(collect(room), expected(room, [](uint32_t, uint32_t) { return true; }), kOnBorders);
}

TEST_F(CollectSurroundingsTest, AWindowLiesInThePlaneOfItsRim) {
    Room room;
    room.open(30, 70, 20, 60);
    // Rims are looked for every third pixel, and a plane's inverse depth is linear: no error beside rounding.
    expect_same(collect(room), expected(room, [](uint32_t, uint32_t) { return true; }), kOnBorders);
}

// Its cells know that they are of a window, and what it shows is kept by direction.
TEST_F(CollectSurroundingsTest, WhatAWindowShowsIsKeptByDirection) {
    for (const float radiance_scale : {0.0f, 2.0f}) {
        Room room;
        room.open(30, 70, 20, 60);
        for (glm::vec4& pixel : room.color.pixels()) pixel = glm::min(pixel, glm::vec4(0.4f));
        collect(room, radiance_scale);
        std::map<int, Sums> wanted;
        std::map<Cell, uint64_t> cells;
        for (uint32_t y = 20; y < 60; ++y) {
            for (uint32_t x = 30; x < 70; ++x) {
                const glm::dvec3 direction = glm::dmat3(room.world_from_camera) * room.ray(x, y);
                Sums& sums = wanted[reference::octahedral_texel(direction, gpu::kOpeningEdge)];
                ++sums.samples;
                sums.color += glm::dvec3(room.color.at(x, y)) * (radiance_scale > 0 ? double{radiance_scale} : 1.0);
                ++cells[room.cell(x, y)];
            }
        }
        ASSERT_GT(wanted.size(), 50u);
        uint64_t apart = 0, all = 0;
        for (size_t i = 0; i < openings.size(); ++i) {
            const gpu::SurroundingsLight& light = openings[i].light;
            const gpu::SurroundingsSums& taken = radiance_scale > 0 ? light.low : light.usual;
            EXPECT_EQ((radiance_scale > 0 ? light.usual : light.low).samples, 0u);
            const auto at = wanted.find(static_cast<int>(i));
            const Sums sums = at == wanted.end() ? Sums{} : at->second;
            apart += taken.samples > sums.samples ? taken.samples - sums.samples : sums.samples - taken.samples;
            all += taken.samples;
            if (taken.samples != sums.samples) continue;
            const glm::dvec3 color = glm::dvec3(taken.r, taken.g, taken.b) / double{gpu::kSurroundingsSteps};
            EXPECT_LT(glm::length(color - sums.color), 0.006 * static_cast<double>(sums.samples) + 1e-6) << i;
        }
        EXPECT_EQ(all, 40u * 40u);
        EXPECT_LT(apart, 12u) << "on borders of texels float and double differ";
        uint64_t off = 0;
        for (const auto& [cell, samples] : of_openings) {
            const uint64_t expected = cells.contains(cell) ? cells[cell] : 0;
            off += expected > samples ? expected - samples : samples - expected;
        }
        EXPECT_LT(off, kOnBorders);
    }
}

// Rays into directions that no window showed take the mean of those around, up to 45 degrees off.
TEST_F(CollectSurroundingsTest, EachDirectionKnowsWhatWindowsShowedAroundIt) {
    // The map's rim, where it is folded, lies around -z.
    for (const glm::dvec3 forward : {glm::dvec3(0.4, 0.1, 1), glm::dvec3(0.1, 0.05, -1), glm::dvec3(1, 0.1, -0.3)}) {
        Room room;
        room.world_from_camera = reference::look_at({0.3, 0.2, 0}, forward);
        room.open(30, 70, 20, 60);
        collect(room, 0, {}, true);
        const auto seen = [&](size_t i) { return openings[i].light.usual.samples >= gpu::kLeastSurroundingsSamples; };
        std::vector<glm::dvec3> directions, colors;
        for (size_t i = 0; i < openings.size(); ++i) {
            const gpu::SurroundingsSums& sums = openings[i].light.usual;
            colors.push_back(glm::dvec3(sums.r, sums.g, sums.b) /
                             (gpu::kSurroundingsSteps * std::max(1.0, 1.0 * sums.samples)));
            const glm::dvec2 at(i % gpu::kOpeningEdge + 0.5, i / gpu::kOpeningEdge + 0.5);
            directions.push_back(direction_of_octahedral(at * (2.0 / gpu::kOpeningEdge) - 1.0));
        }
        uint32_t filled = 0, known = 0;
        double from_nearest = 0;
        for (size_t i = 0; i < openings.size(); ++i) {
            double best = -2, weights = 0;
            glm::dvec3 mean(0), of_nearest(0);
            for (size_t k = 0; k < openings.size(); ++k) {
                if (!seen(k)) continue;
                const double cosine = glm::dot(directions[i], directions[k]);
                if (cosine > best) of_nearest = colors[k];
                best = std::max(best, cosine);
                if (k == i || cosine < std::sqrt(0.5)) continue;
                const double weight = std::min(openings[k].light.usual.samples, 16u) /
                                      std::pow(glm::distance(directions[i], directions[k]), 4);
                mean += weight * colors[k];
                weights += weight;
            }
            const glm::dvec3 shown(openings[i].r, openings[i].g, openings[i].b);
            if (seen(i)) {
                EXPECT_EQ(openings[i].known, 1u);
                EXPECT_LT(glm::distance(shown, colors[i]), 1e-5);
                ++known;
            } else if (best > std::cos(glm::radians(44.9))) {
                ASSERT_EQ(openings[i].known, 1u) << i;
                // A square of the map is no circle of directions where its faces meet.
                EXPECT_LT(glm::distance(shown, mean / weights), 0.02) << i;
                from_nearest = std::max(from_nearest, glm::distance(shown, of_nearest));
                ++filled;
            } else if (best < std::cos(glm::radians(45.1))) {
                EXPECT_EQ(openings[i].known, 0u) << i;
            }
        }
        EXPECT_GT(from_nearest, 0.1) << "one direction alone would show something else";
        EXPECT_GT(known, 80u);
        EXPECT_GT(filled, 100u);
    }
}

TEST_F(CollectSurroundingsTest, ANarrowGapIsNoWindow) {
    Room room;
    room.open(40, 50, 0, kCamera.extent.height);
    expect_same(collect(room), expected(room, [](uint32_t x, uint32_t) { return x < 40 || x >= 50; }), kOnBorders);
}

TEST_F(CollectSurroundingsTest, WhatHasARimOnOneSideAloneIsNowhere) {
    Room room;
    room.open(50, kCamera.extent.width, 0, kCamera.extent.height);
    expect_same(collect(room), expected(room, [](uint32_t x, uint32_t) { return x < 50; }), kOnBorders);
}

TEST_F(CollectSurroundingsTest, LowExposureCountsApartInTheRecordingsPixelValuesWithoutLamps) {
    Room room, bright;
    for (uint32_t y = 0; y < kCamera.extent.height; ++y) {
        for (uint32_t x = 0; x < kCamera.extent.width; ++x) {
            room.color.at(x, y) = glm::vec4(glm::vec3(x < 60 ? 0.25f : 0.75f), 1);
            bright.color.at(x, y) = glm::vec4(glm::vec3(2), 1);
        }
    }
    expect_same(collect(room, 8), expected(bright, [](uint32_t x, uint32_t) { return x < 60; }), kOnBorders);
}

TEST_F(CollectSurroundingsTest, PixelsWithoutAColourDoNotCount) {
    Room room;
    for (glm::vec4& pixel : room.color.pixels()) pixel.a = 0;
    EXPECT_TRUE(collect(room).empty());
}

// A frame that finds the table full adds to the cells that there are, and no others.
TEST_F(CollectSurroundingsTest, AFullTableTakesNoNewCells) {
    const Room room;
    EXPECT_TRUE(collect(room, 0, {gpu::kMostSurroundings, 0, 0, 0}).empty());
    // The first of the sixteen frames, every fourth pixel of every fourth row, still finds room; then it is full.
    const Cells found = collect(room, 0, {gpu::kMostSurroundings - 5, 4, 0, 0});
    const Cells first = expected(room, [](uint32_t x, uint32_t y) { return x % 4 == 0 && y % 4 == 0; });
    EXPECT_NEAR(static_cast<double>(found.size()), static_cast<double>(first.size()), 4) << "some lie on borders";
    EXPECT_GT(collect(room).size(), found.size() + 10);
    EXPECT_GT(first.size(), 50u);
    collect(room, 0, {gpu::kMostSurroundings - 5, 4, 0, 0});
    EXPECT_EQ(counts.total, gpu::kMostSurroundings - 1 + found.size());
    EXPECT_EQ(counts.fresh, 0u);
}

}  // namespace
}  // namespace patina::collect_surroundings_test
