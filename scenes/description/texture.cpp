#include "scenes/description/texture.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>
#include <variant>

#include "engine/core/error.h"
#include "scenes/description/periodic_noise.h"
#include "sensor/files/picture_file.h"

namespace patina::scenes {
namespace {

constexpr uint32_t kTexelsPerCell = 8;    // least width of a cell
constexpr uint32_t kTexelsPerDetail = 4;  // least width of what is drawn: bilinear samples between texels still show it
constexpr uint32_t kSubsamples = 3;       // per texel and axis, for antialiased edges
constexpr float kTwoPi = 2 * std::numbers::pi_v<float>;

/// A place within one of a picture's cells.
struct Cell {
    glm::uvec2 index;
    glm::vec2 local;  ///< 0 .. 1 within the cell
};

/// What the patterns share: the settings, and measures that follow from them. Patterns are functions of (u, v) in
/// [0, 1), constant across the seams.
class Canvas {
  public:
    explicit Canvas(const PatternSettings& settings)
        : settings_(settings), detail_(static_cast<float>(kTexelsPerDetail) / static_cast<float>(settings.size_px)) {}

    glm::vec3 color(size_t index) const { return settings_.colors[index]; }
    /// One of the colours from `first` on, chosen by the cell.
    glm::vec3 any_color(size_t first, glm::uvec2 cell, uint32_t salt = 0) const {
        const size_t choices = settings_.colors.size() - first;
        return settings_.colors[first + hash_cell(cell, settings_.seed + salt) % choices];
    }
    float random(glm::uvec2 cell, uint32_t salt) const { return random_of_cell(cell, settings_.seed + salt); }
    float octaves(glm::vec2 uv, glm::uvec2 cells) const {
        return periodic_octaves(uv, cells, finest(), settings_.seed);
    }
    /// Noise along u alone.
    float waves(float u, uint32_t cells, uint32_t salt) const {
        return periodic_noise({u, 0}, {cells, 1}, settings_.seed + salt);
    }
    /// The finest lattice whose cells still show.
    uint32_t finest() const { return settings_.size_px / kTexelsPerDetail; }
    /// The least width of a line, in (u, v).
    float detail() const { return detail_; }
    uint32_t seed() const { return settings_.seed; }
    glm::uvec2 count() const { return settings_.count; }
    size_t colors() const { return settings_.colors.size(); }

    Cell cell(glm::vec2 uv, glm::uvec2 count) const {
        const glm::vec2 at = glm::fract(uv) * glm::vec2(count);
        const glm::uvec2 index = glm::min(glm::uvec2(at), count - 1u);
        return {index, at - glm::vec2(index)};
    }
    Cell cell(glm::vec2 uv) const { return cell(uv, count()); }

  private:
    const PatternSettings& settings_;
    float detail_;
};

/// Whether a place lies in the rectangle of half size `half` around the middle of the unit square, its corners rounded
/// with `radius`; x and y are in units of `scale`.
bool in_rounded(glm::vec2 local, glm::vec2 scale, glm::vec2 half, float radius) {
    const glm::vec2 beyond = glm::max(glm::abs(local - 0.5f) * scale - (half - radius), glm::vec2(0));
    return glm::length(beyond) <= radius;
}

glm::vec3 checker(const Canvas& canvas, glm::vec2 uv) {
    const Cell cell = canvas.cell(uv);
    return canvas.color((cell.index.x + cell.index.y) % canvas.colors());
}

glm::vec3 stripes(const Canvas& canvas, glm::vec2 uv) {
    return canvas.color(canvas.cell(uv).index.x % canvas.colors());
}

glm::vec3 dots(const Canvas& canvas, glm::vec2 uv) {
    const Cell cell = canvas.cell(uv);
    return glm::distance(cell.local, glm::vec2(0.5f)) < 0.3f ? canvas.any_color(1, cell.index) : canvas.color(0);
}

glm::vec3 weave(const Canvas& canvas, glm::vec2 uv) {
    const Cell cell = canvas.cell(uv);
    const bool along_v = (cell.index.x + cell.index.y) % 2 == 0;  // the thread that lies above the other here
    const glm::vec2 across = along_v ? cell.local : glm::vec2(cell.local.y, cell.local.x);
    const float round = std::sin(std::numbers::pi_v<float> * across.x);               // a thread is round
    const float bent = 0.6f + 0.4f * std::sin(std::numbers::pi_v<float> * across.y);  // and dives at its ends
    const float tone =
        0.8f + 0.2f * canvas.random(along_v ? glm::uvec2(cell.index.x, 0) : glm::uvec2(0, cell.index.y), 1);
    return canvas.color(along_v ? 0 : 1) * ((0.55f + 0.45f * round * bent) * tone);
}

glm::vec3 wood(const Canvas& canvas, glm::vec2 uv) {
    const Cell plank = canvas.cell(uv, {canvas.count().x, 1});
    const glm::uvec2 name(plank.index.x, 0);
    const float end = glm::fract(uv.y + canvas.random(name, 1));  // planks end at different places
    const float width = static_cast<float>(canvas.count().x);
    if (canvas.count().x > 1 && (plank.local.x / width < canvas.detail() || end < canvas.detail()))
        return canvas.color(2);
    // Fibres run along the plank, twelve times as long as wide, bent by slow noise; each plank has its own piece of
    // log.
    const glm::vec2 log = uv + glm::vec2(canvas.random(name, 2), canvas.random(name, 3));
    const float bend = canvas.octaves(log, {2, 2}) - 0.5f;
    const glm::uvec2 fibres(canvas.finest() / 2, std::max(1u, canvas.finest() / 24));
    const float grain = canvas.octaves(log + glm::vec2(0.1f * bend, 0), fibres);
    const float rings = 0.5f + 0.5f * std::sin(kTwoPi * (3 * width * log.x + 4 * bend));
    const float shade = 0.35f * grain + 0.35f * rings + 0.3f * canvas.random(name, 4);
    return glm::mix(canvas.color(0), canvas.color(1), shade);
}

glm::vec3 marble(const Canvas& canvas, glm::vec2 uv) {
    const glm::vec2 veins(canvas.count());
    // Two octaves only: more would fray the veins into specks.
    const float warp = periodic_octaves(uv, {4, 4}, 8, canvas.seed()) - 0.5f;
    const float wave = std::sin(std::numbers::pi_v<float> * (glm::dot(veins, uv) + 2 * warp));
    constexpr float kVein = 0.2f;  // half of the vein's colour where the squared wave is as much
    return glm::mix(canvas.color(1), canvas.color(0), wave * wave / (wave * wave + kVein));
}

glm::vec3 noise(const Canvas& canvas, glm::vec2 uv) {
    // Sums of octaves seldom leave the middle half.
    const float mixed = glm::smoothstep(0.2f, 0.8f, canvas.octaves(uv, canvas.count())) * float(canvas.colors() - 1);
    const size_t below = std::min(static_cast<size_t>(mixed), canvas.colors() - 2);
    return glm::mix(canvas.color(below), canvas.color(below + 1), mixed - static_cast<float>(below));
}

/// Blocks in rows between joints; odd rows are moved by `shift` of a block.
glm::vec3 blocks(const Canvas& canvas, glm::vec2 uv, float shift) {
    const glm::vec2 count(canvas.count());
    const uint32_t row = canvas.cell(uv).index.y;
    const Cell block = canvas.cell(uv + glm::vec2(row % 2 == 1 ? shift / count.x : 0, 0));
    if (glm::any(glm::lessThan(block.local / count, glm::vec2(canvas.detail())))) return canvas.color(0);
    const float tone = 0.85f + 0.15f * canvas.random(block.index, 1);
    return canvas.any_color(1, block.index) * (tone * (0.9f + 0.1f * canvas.octaves(uv, canvas.count() * 2u)));
}

glm::vec3 bricks(const Canvas& canvas, glm::vec2 uv) { return blocks(canvas, uv, 0.5f); }
glm::vec3 tiles(const Canvas& canvas, glm::vec2 uv) { return blocks(canvas, uv, 0); }

glm::vec3 books(const Canvas& canvas, glm::vec2 uv) {
    const uint32_t row = canvas.cell(uv).index.y;
    const float height = canvas.cell(uv).local.y;
    // Spines of different width: each border but the seam is moved by up to a quarter of a spine.
    const auto border = [&](uint32_t i) {
        const float moved = i == 0 || i == canvas.count().x ? 0 : 0.5f * (canvas.random({i, row}, 1) - 0.5f);
        return (static_cast<float>(i) + moved) / static_cast<float>(canvas.count().x);
    };
    uint32_t book = 0;
    while (book + 1 < canvas.count().x && border(book + 1) <= glm::fract(uv.x)) ++book;
    const glm::uvec2 name(book, row);
    const float line = canvas.detail() * static_cast<float>(canvas.count().y);  // the least, as a part of the row
    const auto tier = static_cast<float>(hash_cell(name, canvas.seed() + 2) % 3);
    const float above = tier * std::max(0.08f, line);
    if (height < above || glm::fract(uv.x) - border(book) < canvas.detail()) return canvas.color(0);
    const float along = (height - above) / (1 - above);
    const float title = 0.35f + 0.2f * canvas.random(name, 3);
    return canvas.any_color(1, name) * (std::abs(along - title) < std::max(line, 0.08f) ? 0.45f : 1.0f);
}

glm::vec3 text(const Canvas& canvas, glm::vec2 uv) {
    const Cell line = canvas.cell(uv);
    const glm::uvec2 name = line.index;
    // Words of 40 to 85 % of their cell; each fourth line ends early, as a paragraph does.
    const bool ended = name.y % 4 == 3 && 2 * name.x >= canvas.count().x;
    const bool ink =
        line.local.y > 0.25f && line.local.y < 0.75f && line.local.x < 0.4f + 0.45f * canvas.random(name, 1);
    return ink && !ended ? canvas.any_color(1, name) : canvas.color(0);
}

glm::vec3 keys(const Canvas& canvas, glm::vec2 uv) {
    const glm::vec2 count(canvas.count());
    Cell key = canvas.cell(uv);
    float wide = 1;
    // A pair of neighbours becomes one wide key here and there.
    const glm::uvec2 pair(key.index.x / 2, key.index.y);
    if (canvas.random(pair, 1) < 0.15f && 2 * pair.x + 1 < canvas.count().x) {
        key.local.x = (key.local.x + static_cast<float>(key.index.x % 2)) / 2;
        key.index.x = 2 * pair.x;
        wide = 2;
    }
    const glm::vec2 size = glm::vec2(wide, 1) / count;
    const float radius = canvas.detail() / 2;
    return in_rounded(key.local, size, size / 2.0f - canvas.detail() / 2, radius) ? canvas.any_color(1, key.index)
                                                                                  : canvas.color(0);
}

glm::vec3 poster(const Canvas& canvas, glm::vec2 uv) {
    constexpr float kMargin = 0.06f;
    if (glm::any(glm::greaterThan(glm::abs(glm::fract(uv) - 0.5f), glm::vec2(0.5f - kMargin)))) return canvas.color(0);
    const auto hills = static_cast<uint32_t>(canvas.colors() - 3);
    for (uint32_t hill = hills; hill-- > 0;) {  // the nearest hides the others
        const float middle = 0.45f + 0.4f * (static_cast<float>(hill) + 0.5f) / static_cast<float>(hills);
        const float bumps = canvas.waves(uv.x, 3 + hill, 2 + hill);
        if (uv.y > middle - 0.3f * (bumps - 0.35f)) return canvas.color(3 + hill);
    }
    const glm::vec2 sun(0.3f + 0.4f * canvas.random({0, 0}, 1), 0.25f);
    return glm::distance(uv, sun) < 0.09f ? canvas.color(2) : canvas.color(1);
}

constexpr uint32_t kColors = 0;  // stands for the number of colours

/// All that is known of a pattern.
struct PatternKind {
    const char* name;
    glm::vec3 (*color)(const Canvas&, glm::vec2);
    size_t least_colors;
    glm::uvec2 step{1};  ///< counts are multiples of it: what alternates must fit at the seam
};

/// In the order of Pattern.
const std::vector<PatternKind> kKinds{
    {"checker", checker, 2, {kColors, kColors}},
    {"stripes", stripes, 2, {kColors, 1}},
    {"dots", dots, 2},
    {"weave", weave, 2, {2, 2}},
    {"wood", wood, 3},
    {"marble", marble, 2},
    {"noise", noise, 2},
    {"bricks", bricks, 2, {1, 2}},
    {"tiles", tiles, 2},
    {"books", books, 2},
    {"text", text, 2},
    {"keys", keys, 2},
    {"poster", poster, 4},
};

void check_colors(const PatternKind& kind, const std::vector<glm::vec3>& colors) {
    if (colors.size() < kind.least_colors) {
        throw Error("the pattern '", kind.name, "' takes at least ", kind.least_colors, " colours, but has ",
                    colors.size());
    }
    for (const glm::vec3& c : colors) {
        if (!glm::all(glm::greaterThanEqual(c, glm::vec3(0))) || !glm::all(glm::lessThanEqual(c, glm::vec3(1)))) {
            throw Error("the pattern '", kind.name, "' has the colour ", c.r, ' ', c.g, ' ', c.b, ", outside 0 to 1");
        }
    }
}

/// The seam along one axis shows where the colours' order breaks.
void check_count(const PatternKind& kind, const char* axis, uint32_t count, uint32_t size_px, uint32_t step) {
    if (count == 0 || uint64_t{count} * kTexelsPerCell > size_px) {
        throw Error("the pattern '", kind.name, "' has a count of ", count, ' ', axis, ", outside 1 to ",
                    size_px / kTexelsPerCell, ": cells are at least ", kTexelsPerCell, " of its ", size_px, " texels");
    }
    if (count % step != 0) {
        throw Error("the pattern '", kind.name, "' has a count of ", count, ' ', axis, ", no multiple of ", step,
                    ": it would not repeat without a seam");
    }
}

void check(const PatternKind& kind, const PatternSettings& settings) {
    constexpr uint32_t kLargest_px = 4096;
    if (settings.size_px < 32 || settings.size_px > kLargest_px) {
        throw Error("the pattern '", kind.name, "' has a size of ", settings.size_px, " texels, outside 32 to ",
                    kLargest_px);
    }
    check_colors(kind, settings.colors);
    const auto step = [&](uint32_t own) {
        return own == kColors ? static_cast<uint32_t>(settings.colors.size()) : own;
    };
    check_count(kind, "across", settings.count.x, settings.size_px, step(kind.step.x));
    check_count(kind, "down", settings.count.y, settings.size_px, step(kind.step.y));
}

/// The mean of a texel's samples.
glm::vec3 sampled(const PatternKind& kind, const Canvas& canvas, glm::uvec2 texel, uint32_t size_px) {
    glm::vec3 sum(0);
    for (uint32_t i = 0; i < kSubsamples * kSubsamples; ++i) {
        const glm::vec2 within = (glm::vec2(i % kSubsamples, i / kSubsamples) + 0.5f) / static_cast<float>(kSubsamples);
        sum += kind.color(canvas, (glm::vec2(texel) + within) / static_cast<float>(size_px));
    }
    return glm::clamp(sum / static_cast<float>(kSubsamples * kSubsamples), 0.0f, 1.0f);
}

float linear_of_code(uint8_t code) {
    const double v = code / 255.0;
    return static_cast<float>(v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4));
}

Image<glm::vec3> linear(const Image<SrgbPixel>& codes) {
    Image<glm::vec3> out(codes.extent());
    std::transform(codes.pixels().begin(), codes.pixels().end(), out.pixels().begin(), [](SrgbPixel p) {
        return glm::vec3(linear_of_code(p.r), linear_of_code(p.g), linear_of_code(p.b));
    });
    return out;
}

}  // namespace

Pattern pattern_named(std::string_view name) {
    const auto& names = pattern_names();
    const auto found = std::find(names.begin(), names.end(), name);
    if (found != names.end()) return static_cast<Pattern>(found - names.begin());
    const std::string known = std::accumulate(std::next(names.begin()), names.end(), names.front(),
                                              [](const std::string& a, const std::string& b) { return a + ", " + b; });
    throw Error("there is no pattern '", name, "'; there is: ", known);
}

const std::vector<std::string>& pattern_names() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all;
        for (const PatternKind& kind : kKinds) all.emplace_back(kind.name);
        return all;
    }();
    return names;
}

Image<glm::vec3> draw_pattern(Pattern pattern, const PatternSettings& settings) {
    const PatternKind& kind = kKinds.at(static_cast<size_t>(pattern));
    check(kind, settings);
    const Canvas canvas(settings);
    Image<glm::vec3> picture({settings.size_px, settings.size_px});
    for (uint32_t y = 0; y < settings.size_px; ++y) {
        for (uint32_t x = 0; x < settings.size_px; ++x) {
            picture.at(x, y) = sampled(kind, canvas, {x, y}, settings.size_px);
        }
    }
    return picture;
}

Image<glm::vec3> read_texture(const std::filesystem::path& file) {
    const ColorImage picture = sensor::read_color(file, sensor::picture_extent(file));
    if (const auto* codes = std::get_if<Image<SrgbPixel>>(&picture)) return linear(*codes);
    Image<glm::vec3> albedo = std::get<Image<glm::vec3>>(picture);
    for (const glm::vec3& kd : albedo.pixels()) {
        for (const float value : {kd.r, kd.g, kd.b}) {
            if (!(value >= 0 && value <= 1))
                throw Error(file.string(), " has an albedo of ", value, ", outside 0 to 1");
        }
    }
    return albedo;
}

}  // namespace patina::scenes
