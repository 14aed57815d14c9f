#include "sensor/readers/open3d.h"

#include <array>
#include <set>

#include "engine/core/input_file.h"
#include "sensor/files/json_file.h"
#include "sensor/files/picture_file.h"
#include "sensor/readers/folder_source.h"

namespace patina::sensor {
namespace {

namespace fs = std::filesystem;

constexpr std::array kCameraFiles{"camera_intrinsic.json", "intrinsic.json"};
constexpr std::array kColorExtensions{".jpg", ".png", ".jpeg"};

/// Empty where there is none.
fs::path camera_file(const fs::path& folder) {
    for (const char* name : kCameraFiles)
        if (fs::path file = folder / name; path_exists(file)) return file;
    return {};
}

Intrinsics read_camera(const fs::path& file) {
    const JsonValue root = JsonValue::read(file);
    Intrinsics camera;
    camera.extent = {root.at("width").positive_integer(), root.at("height").positive_integer()};
    check_picture_size(file.string(), camera.extent.width, camera.extent.height);
    const std::vector<JsonValue> matrix = root.at("intrinsic_matrix").elements_of(9);  // column by column
    camera.fx = matrix[0].positive();
    camera.fy = matrix[4].positive();
    camera.cx = matrix[6].number();
    camera.cy = matrix[7].number();
    return camera;
}

/// The names of all frames of which there is any picture, so that a missing one is noticed; in order.
std::vector<std::string> frame_names(const fs::path& folder) {
    std::set<std::string> names;
    for (const fs::path& pictures : {folder / "color", folder / "depth"}) {
        for (const fs::path& entry : entries_of(pictures)) {
            const std::string extension = entry.extension().string();
            for (const char* known : kColorExtensions)
                if (extension == known) names.insert(entry.stem().string());
        }
    }
    return {names.begin(), names.end()};
}

class Open3dSource : public FolderSource {
  public:
    explicit Open3dSource(const fs::path& folder) : folder_(folder), names_(frame_names(folder)) {
        if (names_.empty()) throw Error(folder.string(), " has no frames: no pictures in color/ and depth/");
        info_.name = folder_name(folder);
        info_.format = "open3d";
        info_.frames = static_cast<uint32_t>(names_.size());
        info_.color = info_.depth = read_camera(camera_file(folder));
        info_.metres_per_unit = 0.001;
    }

  private:
    Frame decode(uint32_t index) const override {
        Frame frame;
        frame.index = index;
        frame.timestamp_s = index / info_.fps;
        frame.color = read_color(color_file(names_[index]), info_.color.extent);
        frame.depth = read_depth(folder_ / "depth" / (names_[index] + ".png"), info_.depth.extent);
        return frame;
    }

    fs::path color_file(const std::string& name) const {
        const fs::path stem = folder_ / "color" / name;
        for (const char* extension : kColorExtensions)
            if (fs::path file = stem.string() + extension; path_exists(file)) return file;
        throw Error(stem.string(), " is missing, as .jpg and .png");
    }

    fs::path folder_;
    std::vector<std::string> names_;
};

}  // namespace

bool is_open3d_sequence(const fs::path& folder) {
    return is_folder(folder / "color") && is_folder(folder / "depth") && !camera_file(folder).empty();
}

std::unique_ptr<Source> open_open3d(const fs::path& folder) { return std::make_unique<Open3dSource>(folder); }

}  // namespace patina::sensor
