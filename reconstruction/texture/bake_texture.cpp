#include "reconstruction/texture/bake_texture.h"

#include <algorithm>
#include <utility>

#include "passes/texture/balance_texels.h"
#include "passes/texture/detail_normals.h"
#include "passes/texture/finish_texels.h"
#include "passes/texture/place_texels.h"

namespace patina {
namespace {

// The gutter around a chart is three texels wide: of so large texels no two charts share one.
constexpr uint32_t kMostShrunk = 4;
// Root mean square of the sine between mesh and volume, about 2 degrees: below, there is noise.
constexpr double kLeastDetail = 0.035;

void copy_rows(const TextureBand& band, std::span<const uint32_t> words, TexturePage& page) {
    const size_t first = size_t{band.first_row()} * band.extent().width;
    for (size_t i = 0; i < words.size(); ++i) {
        page.kd.pixels()[first + i] = unpack_albedo(words[i]);
        page.states.pixels()[first + i] = static_cast<TexelState>(state_of(words[i]));
    }
}

bool carries_detail(const std::vector<TexturePage>& pages) {
    double squares = 0, texels = 0;
    for (const TexturePage& page : pages) {
        for (const glm::vec3& normal : page.detail.pixels()) {
            if (normal.z <= 0) continue;
            squares += double{normal.x} * normal.x + double{normal.y} * normal.y;
            ++texels;
        }
    }
    return squares > kLeastDetail * kLeastDetail * texels;
}

}  // namespace

TextureBake::TextureBake(graph::Runner& runner, Stages& stages, const TextureLayout& layout)
    : runner_(runner), stages_(stages), pages_(layout.pages), texel_m_(layout.texel_m) {
    for (const TexturedSurface& piece : layout.pieces) known_ = known_ || !piece.reflectance.kd.empty();
    for (uint32_t page = 0; page < pages_.size(); ++page) {
        const Extent2D extent = pages_[page];
        const uint32_t most = TextureBand::most_rows(extent.width);
        for (uint32_t row = 0; row < extent.height; row += most) {
            const Extent2D rows{extent.width, std::min(most, extent.height - row)};
            bands_.emplace_back(runner.device(), page, row, rows);
        }
    }
    place(layout);
}

void TextureBake::place(const TextureLayout& layout) {
    const TextureTriangles triangles = texture_triangles(layout);
    if (triangles.pages.empty()) return;
    for (const TextureBand& band : bands_) {
        const TileLists lists = list_tiles(triangles, band.page(), band.first_row(), band.extent());
        graph::FrameGraph graph = runner_.begin();
        PlaceTexelsInputs inputs;
        inputs.vertices = graph.upload("texture vertices", std::span(triangles.vertices));
        inputs.triangles = graph.upload("texture triangles", std::span(triangles.indices));
        inputs.tiles = graph.upload("texture tiles", std::span(lists.tiles));
        inputs.lists = graph.upload("texture lists", std::span(lists.lists));
        TextureBand::keep(graph, add_place_texels(graph, band, inputs));
        runner_.submit(std::move(graph));
    }
    runner_.wait();
}

void TextureBake::add(const TexturePicture& picture) {
    graph::FrameGraph graph = runner_.begin();
    const BlendPictureInputs inputs = add_cast_picture(graph, stages_, picture);
    for (const TextureBand& band : bands_)
        TextureBand::keep(graph, add_blend_picture(graph, band, band.import(graph), inputs));
    runner_.submit(std::move(graph));
}

std::vector<TexturePage> TextureBake::finish() {
    std::vector<TexturePage> pages;
    for (uint32_t number = 0; number < pages_.size(); ++number) pages.push_back(finish_page(number));
    return pages;
}

TexturePage TextureBake::finish_page(uint32_t number) {
    const Extent2D extent = pages_[number];
    const glm::uvec2 count = blocks_of(extent);
    TexturePage page{Image<glm::vec3>(extent), Image<TexelState>(extent, TexelState::kEmpty)};
    graph::FrameGraph graph = runner_.begin();
    graph::BufferId blocks =
        graph.fill(graph.create_buffer("texture blocks", uint64_t{count.x} * count.y * sizeof(gpu::TextureBlock)), 0);
    for (const TextureBand& band : bands_)
        if (band.page() == number) blocks = add_average_texels(graph, band, band.import(graph), blocks, extent);
    const TextureBalance balance = add_balance_blocks(graph, blocks, extent, texel_m_, known_);
    std::vector<std::pair<const TextureBand*, graph::Readback>> reads;
    for (const TextureBand& band : bands_) {
        if (band.page() != number) continue;
        reads.emplace_back(&band, graph.read_back(add_finish_texels(graph, band, band.import(graph), balance, extent)));
    }
    runner_.submit(std::move(graph));
    runner_.wait();
    for (const auto& [band, read] : reads) copy_rows(*band, read.as<uint32_t>(), page);
    std::erase_if(bands_, [&](const TextureBand& band) { return band.page() == number; });  // they are large
    return page;
}

void TextureBake::add_detail(const TextureLayout& layout, std::vector<TexturePage>& pages) {
    const TextureTriangles triangles = texture_triangles(layout);
    if (triangles.pages.empty() || triangles.tangents.empty()) return;
    // Differences over two voxels show nothing finer than one.
    const uint32_t shrunk = std::clamp(static_cast<uint32_t>(stages_.settings.map.voxel_m / texel_m_), 1u, kMostShrunk);
    std::vector<Extent2D> extents;
    for (const Extent2D page : pages_)
        extents.push_back({(page.width + shrunk - 1) / shrunk, (page.height + shrunk - 1) / shrunk});
    const TextureTriangles smaller = resized(triangles, pages_, extents);
    for (uint32_t page = 0; page < pages.size(); ++page) pages[page].detail = detail_of(smaller, page, extents[page]);
    if (carries_detail(pages)) return;
    for (TexturePage& page : pages) page.detail = {};
}

Image<glm::vec3> TextureBake::detail_of(const TextureTriangles& triangles, uint32_t page, Extent2D extent) {
    const TileLists lists = list_tiles(triangles, page, 0, extent);
    graph::FrameGraph graph = runner_.begin();
    const VoxelMap& map = stages_.geometry.map();
    PlaceTexelsInputs inputs;
    inputs.vertices = graph.upload("texture vertices", std::span(triangles.vertices));
    inputs.triangles = graph.upload("texture triangles", std::span(triangles.indices));
    inputs.tiles = graph.upload("texture tiles", std::span(lists.tiles));
    inputs.lists = graph.upload("texture lists", std::span(lists.lists));
    const graph::BufferId tangents = graph.upload("texture tangents", std::span(triangles.tangents));
    const graph::Readback read =
        graph.read_back(add_detail_normals(graph, map, map.import(graph), inputs, tangents, extent));
    runner_.submit(std::move(graph));
    runner_.wait();
    Image<glm::vec3> detail(extent);
    std::ranges::transform(read.as<uint32_t>(), detail.pixels().begin(), unpack_detail);
    return detail;
}

}  // namespace patina
