#include "tests/simulated_kinect2/flat_jpeg.h"

#include <bit>
#include <cstdlib>
#include <initializer_list>

namespace patina::sensor::kinect2::testing {
namespace {

constexpr uint8_t kLuminance = 1, kBlue = 2, kRed = 3;

void add(std::vector<uint8_t>& jpeg, std::initializer_list<int> bytes) {
    for (const int byte : bytes) jpeg.push_back(static_cast<uint8_t>(byte));
}

/// Quantises by 8, so that a DC difference of 1 is one grey level.
void add_quantisation(std::vector<uint8_t>& jpeg) {
    add(jpeg, {0xFF, 0xDB, 0, 67, 0});
    jpeg.insert(jpeg.end(), 64, 8);
}

void add_frame(std::vector<uint8_t>& jpeg, uint16_t width, uint16_t height) {
    add(jpeg, {0xFF, 0xC0, 0, 17, 8, height >> 8, height & 255, width >> 8, width & 255, 3});
    add(jpeg, {kLuminance, 0x21, 0, kBlue, 0x11, 0, kRed, 0x11, 0});  // two luminance blocks beside each other a unit
}

/// Codes of the DC table: category 0 is "0", 1 to 8 are "1000" to "1111". The AC table has one code, "0" for end of
/// block.
void add_huffman(std::vector<uint8_t>& jpeg) {
    add(jpeg, {0xFF, 0xC4, 0, 2 + 17 + 9 + 17 + 1});
    add(jpeg, {0x00, 1, 0, 0, 7, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8});
    add(jpeg, {0x10, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x00});
}

class Bits {
  public:
    explicit Bits(std::vector<uint8_t>& jpeg) : jpeg_(jpeg) {}

    void put(uint32_t value, int count) {
        for (int bit = count - 1; bit >= 0; --bit) put_bit(value >> bit & 1);
    }

    void finish() {
        while (filled_ != 0) put_bit(1);
    }

  private:
    void put_bit(uint32_t bit) {
        byte_ = static_cast<uint8_t>(byte_ << 1 | bit);
        if (++filled_ < 8) return;
        jpeg_.push_back(byte_);
        if (byte_ == 0xFF) jpeg_.push_back(0);
        filled_ = 0;
    }

    std::vector<uint8_t>& jpeg_;
    uint8_t byte_ = 0;
    int filled_ = 0;
};

void put_dc(Bits& bits, int difference) {
    const auto magnitude = static_cast<uint32_t>(std::abs(difference));
    const int category = std::bit_width(magnitude);
    if (category == 0) return bits.put(0, 1);
    if (category < 8) {
        bits.put(0b1000u + static_cast<uint32_t>(category) - 1, 4);
    } else {
        bits.put(0b11110u, 5);
    }
    bits.put(difference > 0 ? magnitude : magnitude ^ ((1u << category) - 1), category);
}

}  // namespace

std::vector<uint8_t> flat_jpeg(uint16_t width, uint16_t height, uint8_t grey) {
    std::vector<uint8_t> jpeg;
    add(jpeg, {0xFF, 0xD8});
    add_quantisation(jpeg);
    add_frame(jpeg, width, height);
    add_huffman(jpeg);
    add(jpeg, {0xFF, 0xDA, 0, 12, 3, kLuminance, 0, kBlue, 0, kRed, 0, 0, 63, 0});
    Bits bits(jpeg);
    const uint32_t units = uint32_t{width} / 16 * ((uint32_t{height} + 7) / 8);
    for (uint32_t unit = 0; unit < units; ++unit) {
        for (int block = 0; block < 4; ++block) {
            put_dc(bits, unit == 0 && block == 0 ? grey - 128 : 0);
            bits.put(0, 1);
        }
    }
    bits.finish();
    add(jpeg, {0xFF, 0xD9});
    return jpeg;
}

}  // namespace patina::sensor::kinect2::testing
