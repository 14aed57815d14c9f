#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "patina/frame.h"
#include "patina/texture.h"

namespace patina {

/// A page as an 8-bit picture. `factor_of`: what a segment's base colour is over its diffuse albedo. Texels without
/// surface have the colours around them.
Image<SrgbPixel> page_picture(const TexturePage& page, const std::vector<TextureBox>& boxes, uint32_t number,
                              const std::function<float(uint32_t label)>& factor_of);

/// A picture as a file's bytes: PNG up to a million texels, JPEG above, which is a third of its size.
struct EncodedPicture {
    std::string mime_type;
    std::vector<unsigned char> bytes;
};
EncodedPicture encoded(const Image<SrgbPixel>& picture);

}  // namespace patina
