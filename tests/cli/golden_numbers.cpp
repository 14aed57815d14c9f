#include "tests/cli/golden_numbers.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>

#include <glm/glm.hpp>

#include "engine/core/error.h"
#include "tests/sensor/sequences.h"
#include "tools/eval/exr_planes.h"

namespace patina::testing {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr uint32_t kColumns = 4, kRows = 3;
constexpr uint32_t kFewObservations = 100;  // of fewer, drivers that round differently see another segment's material
constexpr float kFarM = 4;                  // up to here, fusion goes by default

/// Five places are finer than every tolerance.
double rounded(double value) { return std::round(value * 1e5) / 1e5; }
json rounded(const glm::dvec3& v) { return {rounded(v.x), rounded(v.y), rounded(v.z)}; }

json read_json(const fs::path& file) { return json::parse(sensor::testing::read_text(file)); }

// ---- scene.glb ----

/// A binary glTF file: its JSON and its one buffer.
struct Glb {
    explicit Glb(const std::string& bytes) {
        constexpr size_t kHeader = 12, kChunkHeader = 8;
        uint32_t json_bytes = 0;
        if (bytes.size() < kHeader + kChunkHeader) throw Error("scene.glb has only ", bytes.size(), " bytes");
        std::memcpy(&json_bytes, bytes.data() + kHeader, sizeof json_bytes);
        description = json::parse(bytes.substr(kHeader + kChunkHeader, json_bytes));
        buffer = bytes.substr(kHeader + kChunkHeader + json_bytes + kChunkHeader);
    }

    template <class Value>
    std::vector<Value> values(const json& accessor_index) const {
        const json& accessor = description.at("accessors").at(accessor_index.get<size_t>());
        const json& view = description.at("bufferViews").at(accessor.at("bufferView").get<size_t>());
        std::vector<Value> result(accessor.at("count").get<size_t>());
        const size_t first = view.value("byteOffset", size_t{0}), bytes = result.size() * sizeof(Value);
        if (first > buffer.size() || bytes > buffer.size() - first) throw Error("scene.glb is cut short");
        std::memcpy(result.data(), buffer.data() + first, bytes);
        return result;
    }

    std::vector<uint32_t> indices(const json& accessor_index) const {
        constexpr int kUnsignedShort = 5123;
        if (description.at("accessors").at(accessor_index.get<size_t>()).at("componentType") != kUnsignedShort)
            return values<uint32_t>(accessor_index);
        const auto shorts = values<uint16_t>(accessor_index);
        return {shorts.begin(), shorts.end()};
    }

    json description;
    std::string buffer;
};

json surface_of(const fs::path& file) {
    const Glb glb(sensor::testing::read_text(file));
    size_t vertices = 0, triangles = 0;
    double area_m2 = 0;
    glm::dvec3 minimum_m(INFINITY), maximum_m(-INFINITY);
    for (const json& mesh : glb.description.at("meshes")) {
        const json& primitive = mesh.at("primitives").at(0);
        const auto points = glb.values<std::array<float, 3>>(primitive.at("attributes").at("POSITION"));
        const auto indices = glb.indices(primitive.at("indices"));
        const auto point = [&](size_t i) {
            const auto& p = points.at(indices[i]);
            return glm::dvec3(p[0], p[1], p[2]);
        };
        for (size_t i = 0; i + 2 < indices.size(); i += 3) {
            const glm::dvec3 corner = point(i);
            area_m2 += 0.5 * glm::length(glm::cross(point(i + 1) - corner, point(i + 2) - corner));
        }
        for (const auto& p : points) {
            minimum_m = glm::min(minimum_m, glm::dvec3(p[0], p[1], p[2]));
            maximum_m = glm::max(maximum_m, glm::dvec3(p[0], p[1], p[2]));
        }
        vertices += points.size();
        triangles += indices.size() / 3;
    }
    return {{"vertices", vertices},
            {"triangles", triangles},
            {"area_m2", rounded(area_m2)},
            {"minimum_m", rounded(minimum_m)},
            {"maximum_m", rounded(maximum_m)}};
}

// ---- materials.json, lights.json ----

json materials_of(const fs::path& file) {
    json materials = json::object();
    const json read = read_json(file);
    for (const json& material : read.at("materials")) {
        if (material.at("observations") < kFewObservations) continue;
        json& numbers = materials["segment " + std::to_string(material.at("id").get<uint32_t>())];
        if (material.contains("kd")) numbers["kd"] = material["kd"];
        const json& gloss = material.contains("guess") ? material["guess"] : material;
        for (const char* name : {"ks", "alpha"}) {
            if (gloss.contains(name)) numbers[name] = gloss[name];
        }
    }
    return materials;
}

json lights_of(const fs::path& file) {
    json lights = json::array();
    const json read = read_json(file);
    for (const json& light : read.at("lights")) {
        lights.push_back({{"position_m", light.at("position")}, {"intensity", light.at("intensity")}});
    }
    return lights;
}

// ---- frames/NNNNNN.exr ----

/// Means over the pixels of a cell that show the surface.
struct CellMeans {
    double pixels = 0, shown = 0, far = 0, depth_m = 0;
    glm::dvec3 normal{0}, rgb{0}, kd{0};

    json numbers() const {
        const double n = std::max(shown, 1.0);
        return {{"shown", rounded(shown / pixels)}, {"beyond_4_m", rounded(far / pixels)},
                {"depth_m", rounded(depth_m / n)},  {"normal", rounded(normal / n)},
                {"rgb", rounded(rgb / n)},          {"kd", rounded(kd / n)}};
    }
};

json view_of(const fs::path& file) {
    const auto planes = eval::ExrPlanes::read(file);
    const Extent2D extent = planes.extent();
    const std::vector<float>& depth_m = planes.plane("depth");
    const auto vector_at = [&](size_t i, const char* x, const char* y, const char* z) {
        return glm::dvec3(planes.plane(x)[i], planes.plane(y)[i], planes.plane(z)[i]);
    };
    std::array<CellMeans, kColumns * kRows> cells;
    for (size_t i = 0; i < depth_m.size(); ++i) {
        const size_t column = i % extent.width * kColumns / extent.width,
                     row = i / extent.width * kRows / extent.height;
        CellMeans& cell = cells.at(row * kColumns + column);
        ++cell.pixels;
        if (!(depth_m[i] > 0)) continue;
        ++cell.shown;
        cell.far += depth_m[i] > kFarM;
        cell.depth_m += depth_m[i];
        cell.normal += vector_at(i, "normal.X", "normal.Y", "normal.Z");
        cell.rgb += vector_at(i, "rgb_shown.R", "rgb_shown.G", "rgb_shown.B");
        cell.kd += vector_at(i, "kd_shown.R", "kd_shown.G", "kd_shown.B");
    }
    json numbers{{"farthest_m", rounded(*std::ranges::max_element(depth_m))}, {"cells", json::array()}};
    for (const CellMeans& cell : cells) numbers["cells"].push_back(cell.numbers());
    return numbers;
}

/// Of the path to a number, as "/view/cells/3/depth_m", the last part that is no index.
std::string name_of(const std::string& path) {
    size_t end = path.size();
    for (;;) {
        const size_t slash = path.rfind('/', end - 1);
        const std::string part = path.substr(slash + 1, end - slash - 1);
        if (slash == 0 || !std::ranges::all_of(part, [](unsigned char c) { return std::isdigit(c) != 0; })) return part;
        end = slash;
    }
}

}  // namespace

json golden_numbers(const fs::path& run_folder, const std::string& frame) {
    return {{"surface", surface_of(run_folder / "scene.glb")},
            {"materials", materials_of(run_folder / "materials.json")},
            {"lights", lights_of(run_folder / "lights.json")},
            {"view", view_of(run_folder / "frames" / (frame + ".exr"))}};
}

double golden_tolerance(const std::string& path, double stored) {
    struct Tolerance {
        double absolute, relative;
    };
    // Five times and more the largest difference between lavapipe (Mesa 22.3; 128 and 256 bits give the same bytes) and
    // SwiftShader in both scenes, which stands behind; a 5 mm voxel where they agree on the surface.
    static const std::map<std::string, Tolerance> tolerances{
        {"vertices", {0, 1e-3}},     // 1.5e-4
        {"triangles", {0, 1e-3}},    // 6e-6
        {"area_m2", {0, 1e-3}},      // none
        {"minimum_m", {0.005, 0}},   // none
        {"maximum_m", {0.005, 0}},   // none
        {"shown", {0.01, 0}},        // none; 12 pixels of a cell
        {"beyond_4_m", {0.01, 0}},   // none
        {"farthest_m", {0.005, 0}},  // 0.00001
        {"depth_m", {0.001, 0}},     // 0.00001
        {"normal", {0.01, 0}},       // 0.0017
        {"rgb", {0.005, 0}},         // 0.0009
        {"kd", {0.02, 0}},           // 0.0041, of a segment
        {"ks", {0.01, 0}},           // 0.0018
        {"alpha", {0.02, 0}},        // 0.0038
        {"position_m", {0.005, 0}},  // 0.000001
        {"intensity", {0, 5e-3}},    // 8e-4
    };
    const Tolerance& tolerance = tolerances.at(name_of(path));
    return tolerance.absolute + tolerance.relative * std::abs(stored);
}

std::vector<std::string> golden_differences(const json& stored, const json& measured) {
    std::vector<std::string> differences;
    const json before = stored.flatten(), now = measured.flatten();
    for (const auto& [path, value] : before.items()) {
        if (!now.contains(path)) {
            differences.push_back(text(path, " is missing; ", value.dump(), " is stored"));
            continue;
        }
        const json& other = now[path];
        if (!value.is_number() || !other.is_number()) {
            if (value != other) differences.push_back(text(path, " is ", other.dump(), ", stored ", value.dump()));
            continue;
        }
        const double wanted = value.get<double>(), tolerance = golden_tolerance(path, wanted);
        if (std::abs(other.get<double>() - wanted) <= tolerance) continue;
        differences.push_back(text(path, " is ", other.dump(), ", stored ", value.dump(), ", tolerance ", tolerance));
    }
    for (const auto& [path, value] : now.items()) {
        if (!before.contains(path)) differences.push_back(text(path, " is ", value.dump(), "; nothing is stored"));
    }
    return differences;
}

}  // namespace patina::testing
