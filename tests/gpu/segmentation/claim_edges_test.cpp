#include "passes/segmentation/claim_edges.h"

#include <random>

#include "engine/core/shader_camera.h"
#include "shared/segmentation/contacts.h"
#include "shared/segmentation/number_segments.h"
#include "tests/gpu/gpu_test.h"
#include "tests/gpu/input/input_pictures.h"
#include "tests/reference/segmentation/claim_edges.h"

namespace patina::claim_edges_test {
namespace {

using reference::ContactSum;
using Contacts = std::map<std::pair<uint32_t, uint32_t>, ContactSum>;

/// As shaders/lib/segments/frame_surface.glsl and chroma.glsl say.
uint32_t packed_normal(glm::dvec3 n) {
    n /= std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
    if (n.z < 0) {
        n = {std::copysign(1 - std::abs(n.y), n.x), std::copysign(1 - std::abs(n.x), n.y), n.z};
    }
    const auto bits = [](double v) { return static_cast<uint32_t>(std::lround(v * 32767) + 32768); };
    return bits(n.x) | bits(n.y) << 16;
}
uint32_t packed_chroma(const std::optional<glm::ivec2>& chroma) {
    return chroma ? static_cast<uint32_t>(chroma->x) | static_cast<uint32_t>(chroma->y) << 12 | 100u << 24 : 0;
}

/// Tiles of a bumpy plane with gaps of up to twice the reach between them; the first one is too small and far from
/// others.
reference::ComponentPicture tiles(Extent2D extent, uint32_t seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> bump_m(0, 0.006), tilt(0, 0.15);
    reference::ComponentPicture picture{pinhole_camera(extent), Image<uint32_t>(extent), Image<float>(extent),
                                        Image<glm::dvec3>(extent), Image<std::optional<glm::ivec2>>(extent)};
    std::map<uint32_t, glm::ivec2> colors;
    for (uint32_t y = 0; y < extent.height; ++y) {
        for (uint32_t x = 0; x < extent.width; ++x) {
            const uint32_t column = x / 20, row = y / 17, gap = 2 + (column + row) % 9;
            const bool small = column == 0 && row == 0, left_out = column < 2 && row < 2;
            const bool inside = small ? x < 4 && y < 5 : !left_out && x % 20 >= gap && y % 17 >= gap / 2;
            // Keys in no order; a tile has holes.
            const uint64_t first = uint64_t{row} * 17 * extent.width + column * 20;
            const bool hole = random() % 40 == 0;
            const uint32_t key = inside && !hole ? 1 + static_cast<uint32_t>(first * 7919 % extent.area()) : 0;
            picture.component.at(x, y) = key;
            picture.depth_m.at(x, y) = inside || random() % 12 != 0 ? static_cast<float>(1.5 + bump_m(random)) : 0.0f;
            picture.normal.at(x, y) = glm::normalize(glm::dvec3(tilt(random), tilt(random), -1));
            const auto [color, added] = colors.try_emplace(key, 1000 + random() % 900, 1000 + random() % 900);
            if (random() % 9 != 0) {
                picture.chroma.at(x, y) = color->second + glm::ivec2(random() % 100, random() % 100);
            }
        }
    }
    return picture;
}

class ClaimEdges : public GpuTest {
  protected:
    struct Result {
        Image<uint32_t> component;
        Contacts contacts;
    };

    Result claim(const reference::ComponentPicture& picture) {
        const Extent2D extent = picture.component.extent();
        graph::FrameGraph frame = runner().begin();
        const auto upload = [&](const char* name, vulkan::Format format, const auto& pixels) {
            return frame.upload(name, {extent, format}, std::as_bytes(std::span(pixels)));
        };
        std::vector<uint32_t> normals, chroma, pixels(extent.area() + 1);
        for (const glm::dvec3& normal : picture.normal.pixels()) normals.push_back(packed_normal(normal));
        for (const auto& known : picture.chroma.pixels()) chroma.push_back(packed_chroma(known));
        for (const uint32_t key : picture.component.pixels()) pixels[key] += key != 0 ? 1 : 0;
        const FrameSurface surface{upload("depth_m", vulkan::Format::kR32f, picture.depth_m.pixels()),
                                   upload("chroma", vulkan::Format::kR32u, chroma)};
        const ClaimedEdges claimed = add_claim_edges(
            frame, upload("component", vulkan::Format::kR32u, picture.component.pixels()),
            frame.upload<uint32_t>("pixels", pixels), surface, upload("normal", vulkan::Format::kR32u, normals),
            make_surface_params(make_camera(picture.camera, RigidTransform(1)), {}, 60));
        const graph::Readback component = frame.read_back(claimed.component),
                              table = frame.read_back(claimed.contacts.table),
                              count = frame.read_back(claimed.contacts.count);
        run(std::move(frame));
        Result result{component.image<uint32_t>(), {}};
        for (const gpu::Contact& contact : table.as<gpu::Contact>()) {
            if (contact.low == 0) continue;
            const ContactSum sum{contact.pixels, {contact.low_r, contact.low_g}, {contact.high_r, contact.high_g}};
            EXPECT_TRUE(result.contacts.insert({{contact.low, contact.high}, sum}).second);
        }
        EXPECT_EQ(count.as<uint32_t>().front(), result.contacts.size());
        return result;
    }
};

TEST_F(ClaimEdges, AgreesWithTheReference) {
    for (const Extent2D extent : kPictureExtents) {
        const reference::ComponentPicture picture = tiles(extent, extent.width);
        const Result got = claim(picture);
        const reference::Claims expected = reference::claim_edges(picture);
        size_t differ = 0, claimed = 0;
        for (size_t i = 0; i < extent.area(); ++i) {
            differ += got.component.pixels()[i] != expected.component.pixels()[i];
            claimed += expected.component.pixels()[i] != picture.component.pixels()[i];
        }
        // Single precision decides otherwise where a pixel is as near to two planes, or just within the limit.
        EXPECT_LE(differ, extent.area() / 1000) << extent;
        size_t touching = 0, off = 0;
        for (const auto& [keys, contact] : expected.contacts) {
            const auto found = got.contacts.find(keys);
            touching += contact.pixels;
            off += found == got.contacts.end() || found->second != contact ? 1 : 0;
        }
        EXPECT_LE(off, expected.contacts.size() / 50) << extent;
        EXPECT_NEAR(static_cast<double>(got.contacts.size()), static_cast<double>(expected.contacts.size()), 2);
        if (extent.area() < 100000) continue;
        EXPECT_GT(claimed, 20000u);
        EXPECT_GT(touching, 10000u);
    }
}

TEST_F(ClaimEdges, APixelBetweenTwoPlanesGoesToTheOneOfItsColour) {
    const Extent2D extent{41, 12};
    reference::ComponentPicture picture{pinhole_camera(extent), Image<uint32_t>(extent), Image<float>(extent, 1),
                                        Image<glm::dvec3>(extent, {0, 0, -1}),
                                        Image<std::optional<glm::ivec2>>(extent, glm::ivec2(2000, 1000))};
    for (uint32_t y = 0; y < extent.height; ++y) {
        for (uint32_t x = 0; x < extent.width; ++x) {
            if (x < 19) picture.component.at(x, y) = 1;
            if (x > 21) picture.component.at(x, y) = 23;
            if (x > 21 || y >= 6) picture.chroma.at(x, y) = glm::ivec2(1200, 1400);
            if (x < 19) picture.chroma.at(x, y) = glm::ivec2(2000, 1000);
        }
    }
    const Result got = claim(picture);
    for (uint32_t y = 0; y < extent.height; ++y) {
        for (uint32_t x = 19; x <= 21; ++x) EXPECT_EQ(got.component.at(x, y), y < 6 ? 1u : 23u) << x << ' ' << y;
    }
    const Contacts expected{{{1, 23}, {36, glm::ivec2(2000, 1000) * 36, glm::ivec2(1200, 1400) * 36}}};
    EXPECT_EQ(got.contacts, expected);
}

TEST_F(ClaimEdges, APixelThatFoldsAwayFromAComponentJoinsItIfItHasItsHue) {
    const Extent2D extent{41, 12};
    for (const bool pale : {true, false}) {
        for (const double tilt : {0.7, -0.7}) {
            const glm::dvec3 normal = glm::normalize(glm::dvec3(tilt, 0, -1));  // of the component on the left
            reference::ComponentPicture picture{pinhole_camera(extent), Image<uint32_t>(extent),
                                                Image<float>(extent, 1), Image<glm::dvec3>(extent, normal),
                                                Image<std::optional<glm::ivec2>>(extent, glm::ivec2(2400, 900))};
            for (uint32_t y = 0; y < extent.height; ++y) {
                for (uint32_t x = 0; x < extent.width; ++x) {
                    if (x < 19) picture.component.at(x, y) = 1;
                    if (x >= 19) picture.chroma.at(x, y) = pale ? glm::ivec2(1900, 1120) : glm::ivec2(1900, 1700);
                }
            }
            const Result got = claim(picture);
            EXPECT_EQ(got.component.at(24, 6), pale && tilt < 0 ? 1u : 0u) << pale << ' ' << tilt;
        }
    }
}

class JoinFolds : public GpuTest {
  protected:
    /// Pixels by key, with gpu::kForwardedKey | root where a component was joined to another.
    std::vector<uint32_t> join(const Contacts& contacts, const std::vector<uint32_t>& pixels, uint32_t used) {
        std::vector<gpu::Contact> table(gpu::kContactSlots);
        size_t slot = 5;
        for (const auto& [keys, sum] : contacts) {
            const auto u = [](int v) { return static_cast<uint32_t>(v); };
            table[slot] = {keys.first,   keys.second,  sum.pixels,    0,
                           u(sum.low.x), u(sum.low.y), u(sum.high.x), u(sum.high.y)};
            slot = (slot + 7) % table.size();
        }
        std::vector<uint32_t> parents;
        for (uint32_t key = 1; key < pixels.size(); ++key) parents.push_back(key - 1);
        graph::FrameGraph frame = runner().begin();
        const patina::Contacts uploaded{frame.upload<gpu::Contact>("table", std::span(std::as_const(table))),
                                        frame.upload<uint32_t>("count", std::span(&std::as_const(used), 1))};
        const graph::Readback read = frame.read_back(add_join_folds(
            frame, uploaded, frame.upload<uint32_t>("parents", parents), frame.upload<uint32_t>("pixels", pixels), {}));
        run(std::move(frame));
        return read.as<uint32_t>();
    }
};

/// Whether single precision says the same: no limit is near.
bool is_clear(const ContactSum& contact) {
    bool all = true, any = false;
    for (const double more : {-1e-4, 1e-4}) {
        const reference::FoldRules usual;
        for (const reference::FoldRules& rules :
             {reference::FoldRules{.strong_chroma = usual.strong_chroma * (1 + more)},
              {.same_hue_degrees = usual.same_hue_degrees * (1 + more)},
              {.same_saturation = usual.same_saturation * (1 + more)},
              {.least_weight = usual.least_weight * (1 + more)}}) {
            const bool fold = reference::is_fold(contact, rules);
            all = all && fold;
            any = any || fold;
        }
    }
    return all == any;
}

TEST_F(JoinFolds, AgreesWithTheReference) {
    constexpr uint32_t kKeys = 900;
    std::mt19937 random(31);
    const auto below = [&](uint32_t end) { return static_cast<uint32_t>(random() % end); };
    std::vector<uint32_t> pixels(kKeys + 1);
    for (uint32_t key = 1; key <= kKeys; ++key) pixels[key] = 60 + below(500);
    Contacts contacts;
    std::set<std::pair<uint32_t, uint32_t>> folds;
    while (contacts.size() < 1200) {
        const uint32_t a = 1 + below(kKeys), b = 1 + below(kKeys);
        if (a >= b) continue;
        const int count = 1 + static_cast<int>(below(80));
        const glm::ivec2 color(1365 + below(2000), below(1365));
        // Some on the other side of grey.
        const glm::ivec2 other = below(5) == 0 ? 2 * 1365 - color : color + glm::ivec2(below(200), below(200)) - 100;
        const ContactSum sum{static_cast<uint32_t>(count), color * count, glm::max(other, glm::ivec2(0)) * count};
        if (is_clear(sum)) contacts[{a, b}] = sum;
    }
    for (const auto& [keys, sum] : contacts) {
        if (reference::is_fold(sum)) folds.insert(keys);
    }
    ASSERT_GT(folds.size(), 100u);
    ASSERT_LT(folds.size(), 800u);
    std::vector<uint32_t> expected = pixels;
    for (const auto& [key, root] : reference::joined(folds)) {
        if (root == key) continue;
        expected[root] += pixels[key];
        expected[key] = gpu::kForwardedKey | root;
    }
    EXPECT_EQ(join(contacts, pixels, static_cast<uint32_t>(contacts.size())), expected);
    EXPECT_EQ(join(contacts, pixels, gpu::kMostContacts), pixels) << "an incomplete table joins nothing";
}

}  // namespace
}  // namespace patina::claim_edges_test
