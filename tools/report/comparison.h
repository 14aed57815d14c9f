#pragma once

#include <span>
#include <string>

#include "patina/frame.h"

namespace patina {

/// A recorded picture, and what the model looks like from there; both of one extent.
struct PicturePair {
    std::string caption;
    Extent2D extent;
    std::string recorded, rendered;  ///< the bytes of JPEG files
};

/// Pictures one over the other, as markup: a slider uncovers the recorded one, by mouse, finger and arrow keys. One
/// pair shows at a time; buttons choose which. Nothing where there is none.
std::string comparison_html(std::span<const PicturePair> pairs);
std::string comparison_style();

}  // namespace patina
