#pragma once

#include <string>

#include "export/write_exr.h"
#include "patina/frame.h"
#include "tools/report/comparison.h"

namespace patina {

/// What a preview shows beside the input, the reconstruction and the normals.
struct PreviewOptions {
    std::string title{};              ///< added to the first caption, as "frame 12"
    bool depth = false;               ///< a fourth panel with the model's depth
    uint32_t largest_panel_px = 640;  ///< wider panels are scaled down to this width
};

/// A PNG file (its bytes) with panels side by side under small captions: the input colour, the model's colour as the
/// same camera sees it (sRGB-encoded), where the model has them its diffuse albedo and its segments, its world
/// normals as n / 2 + 1/2, and on request its depth from near (blue) to far (red). All panels have the extent of
/// `model.rgb`, scaled down where wider than asked for; the input is resampled to it. Where the model was not hit,
/// panels are dark grey. Throws Error when the pictures of `model` differ in extent or any is empty.
std::string preview_png(const ColorImage& input, const FrameDump& model, const PreviewOptions& options = {});

/// The input colour and the model's as the same camera sees it, both of the extent of `model.rgb`, or scaled down where
/// that is wider than 960 pixels. Errors as preview_png().
PicturePair picture_pair(const ColorImage& input, const FrameDump& model, const std::string& caption);

}  // namespace patina
