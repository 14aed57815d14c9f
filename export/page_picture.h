#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "patina/frame.h"
#include "patina/texture.h"

namespace patina {

struct PagePicture {
    Image<SrgbPixel> picture;
    uint64_t clamped = 0;  ///< texels with a channel above 1
};

/// A page as an 8-bit picture. `factor_of`: what a segment's base colour is over its diffuse albedo. Texels without
/// surface have the colours around them.
PagePicture page_picture(const TexturePage& page, const std::vector<TextureBox>& boxes, uint32_t number,
                         const std::function<float(uint32_t label)>& factor_of);

/// Unit normals as glTF's normalTexture has them: n / 2 + 1/2 of 255. Where there is none, the mesh's own.
Image<SrgbPixel> detail_picture(const Image<glm::vec3>& detail);

/// A picture as a file's bytes: PNG up to a million texels, JPEG above, which is a third of its size.
struct EncodedPicture {
    std::string mime_type;
    std::vector<unsigned char> bytes;
};
/// ".png" or ".jpg".
const char* extension_of(const EncodedPicture& picture);
EncodedPicture encoded(const Image<SrgbPixel>& picture);
/// As PNG, whatever the size.
EncodedPicture encoded_as_png(const Image<SrgbPixel>& picture);
/// As JPEG of a quality from 1 to 100.
EncodedPicture encoded_as_jpeg(const Image<SrgbPixel>& picture, int quality);

/// Where a page's colours are filled in rather than seen: a grey PNG of a quarter of its width and height. A pixel is 0
/// where at least half of the surface in its 4 x 4 texels was shown by no picture, else 255.
EncodedPicture seen_mask(const Image<TexelState>& states);

/// The pixels of an encoded picture. Throws Error where it is damaged.
Image<SrgbPixel> decoded(const EncodedPicture& picture);
Image<glm::vec3> linear_page(const EncodedPicture& picture);

/// At half the resolution: each pixel is the mean of four codes.
Image<SrgbPixel> halved(const Image<SrgbPixel>& fine);

/// The linear colour between the four texels around a place, which is 0 to 1 from the page's top left corner.
glm::vec3 texel_at(const Image<glm::vec3>& page, glm::vec2 place);

}  // namespace patina
