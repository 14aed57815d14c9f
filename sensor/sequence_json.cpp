#include "sensor/sequence_json.h"

#include <algorithm>
#include <vector>

#include "engine/core/input_file.h"
#include "sensor/camera_json.h"
#include "sensor/pose.h"

namespace patina::sensor {

namespace {

using Json = nlohmann::ordered_json;

RigidTransform read_transform(const JsonValue& value) {
    return checked_pose(matrix_from_rows(value.numbers(16)), value.where()).transform;
}

void expect_format(const JsonValue& root) {
    const std::string format = root.at("format").string();
    if (format != "patina-sequence") {
        throw Error(root.at("format").where(), " is \"", format, "\", must be \"patina-sequence\"");
    }
    const uint32_t version = root.at("version").positive_integer();
    if (version != 1) throw Error(root.at("version").where(), " is ", version, ", but this program reads version 1");
}

Json rows_of(const RigidTransform& transform) {
    Json rows = Json::array();
    for (int i = 0; i < 16; ++i) rows.push_back(transform[i % 4][i / 4]);
    return rows;
}

}  // namespace

SequenceDescription parse_sequence(const JsonValue& root, const std::string& default_name) {
    expect_format(root);
    const JsonValue color = root.at("color");
    const JsonValue depth = root.at("depth");
    SequenceDescription sequence;
    SequenceInfo& info = sequence.info;
    info.format = "patina-sequence";
    info.name = root.find("name") ? root.at("name").string() : default_name;
    info.fps = root.find("fps") ? root.at("fps").positive() : info.fps;
    if (const auto frames = root.find("frames")) info.frames = frames->positive_integer();
    info.color = read_camera(color);
    info.depth = read_camera(depth);
    info.metres_per_unit = depth.at("metres_per_unit").positive();
    if (const auto far = depth.find("max_metres")) info.max_metres = far->positive();
    if (const auto transform = root.find("depth_to_color")) info.color_from_depth = read_transform(*transform);
    if (const auto gravity = root.find("gravity")) info.gravity = read_direction(*gravity);
    if (const auto exposure = color.find("exposure_s")) {
        sequence.exposure.exposure_s = exposure->positive();
        info.exposure_known = true;
    }
    if (const auto gain = color.find("gain")) sequence.exposure.gain = gain->positive();
    if (const auto blur = color.find("motion_blur")) info.motion_blur = blur->boolean();
    if (const auto indirect = root.find("indirect_light")) info.indirect_light = indirect->boolean();
    return sequence;
}

nlohmann::ordered_json sequence_json(const SequenceInfo& info, const Exposure& exposure) {
    Json color = camera_json(info.color);
    if (info.exposure_known) {
        color["exposure_s"] = exposure.exposure_s;
        color["gain"] = exposure.gain;
    }
    if (!info.motion_blur) color["motion_blur"] = false;
    Json depth = camera_json(info.depth);
    depth["metres_per_unit"] = info.metres_per_unit;
    depth["max_metres"] = info.max_metres;
    Json root{{"format", "patina-sequence"}, {"version", 1}, {"name", info.name}, {"fps", info.fps}};
    if (info.frames) root["frames"] = *info.frames;
    root["color"] = color;
    root["depth"] = depth;
    root["depth_to_color"] = rows_of(info.color_from_depth);
    if (info.gravity) root["gravity"] = {info.gravity->x, info.gravity->y, info.gravity->z};
    if (!info.indirect_light) root["indirect_light"] = false;
    return root;
}

}  // namespace patina::sensor
