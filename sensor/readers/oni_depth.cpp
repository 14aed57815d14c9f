#include "sensor/readers/oni_depth.h"

#include "engine/core/error.h"

namespace patina::sensor {

namespace {

constexpr uint32_t kFill = 13, kStep = 15;              // half bytes
constexpr uint32_t kRepeats = 0xe0, kWholeStep = 0xff;  // bytes, from the first on
constexpr int kSmallMiddle = 6, kLargeMiddle = 192;     // what stands for no difference

class Decoder {
  public:
    Decoder(std::span<const uint8_t> bytes, size_t count, bool has_table) : bytes_(bytes), count_(count) {
        values_.reserve(count);
        if (has_table) read_table();
    }

    std::vector<uint16_t> decode() {
        last_ = word();
        put();
        while (at_ < bytes_.size()) {
            const uint32_t code = byte();
            if (code == kWholeStep) {
                step();
            } else if (code >= kRepeats) {
                for (uint32_t i = 0; i < 2 * (code - kRepeats); ++i) put();
            } else {
                half(code >> 4);
                half(code & 15);
            }
        }
        if (values_.size() != count_) throw Error("holds ", values_.size(), " values, not ", count_);
        return std::move(values_);
    }

  private:
    void read_table() {
        table_.resize(word());
        for (uint16_t& value : table_) value = static_cast<uint16_t>(word());
    }

    void half(uint32_t code) {
        if (code == kFill) return;
        if (code == kStep) return step();
        last_ -= static_cast<int>(code) - kSmallMiddle;
        put();
    }

    void step() {
        const uint32_t high = byte();
        if (high & 0x80) {
            last_ -= static_cast<int>(high) - kLargeMiddle;
        } else {
            last_ = static_cast<int>(high << 8 | byte());
        }
        put();
    }

    /// The codec counts in 16 bits.
    void put() {
        if (values_.size() == count_) throw Error("holds more than ", count_, " values");
        const auto value = static_cast<uint16_t>(last_);
        if (!table_.empty() && value >= table_.size())
            throw Error("names value ", value, " of a table of ", table_.size());
        values_.push_back(table_.empty() ? value : table_[value]);
    }

    uint32_t byte() {
        if (at_ == bytes_.size()) throw Error("ends after ", values_.size(), " of ", count_, " values");
        return bytes_[at_++];
    }

    int word() {
        const uint32_t low = byte();
        return static_cast<int>(low | byte() << 8);
    }

    std::span<const uint8_t> bytes_;
    size_t at_ = 0, count_;
    std::vector<uint16_t> table_, values_;
    int last_ = 0;
};

}  // namespace

std::vector<uint16_t> decode_oni_depth(std::span<const uint8_t> bytes, size_t count, bool has_table) {
    return Decoder(bytes, count, has_table).decode();
}

}  // namespace patina::sensor
