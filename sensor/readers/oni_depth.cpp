#include "sensor/readers/oni_depth.h"

#include "engine/core/error.h"

namespace patina::sensor {

namespace {

constexpr uint32_t kFill = 13, kStep = 15;                // half bytes
constexpr uint32_t kRepeats = 0xe0, kWholeStep = 0xff;    // bytes, from the first on
constexpr uint32_t kSmallMiddle = 6, kLargeMiddle = 192;  // what stands for no difference
constexpr size_t kMostOfAByte = 2 * (kWholeStep - 1 - kRepeats);

class Decoder {
  public:
    Decoder(std::span<const uint8_t> bytes, size_t count, bool has_table) : bytes_(bytes), count_(count) {
        if (count > 1 + kMostOfAByte * bytes.size())
            throw Error("has ", bytes.size(), " bytes, which cannot hold ", count, " values");
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
        for (uint16_t& value : table_) value = word();
    }

    void half(uint32_t code) {
        if (code == kFill) return;
        if (code == kStep) return step();
        last_ = static_cast<uint16_t>(last_ + kSmallMiddle - code);
        put();
    }

    void step() {
        const uint32_t high = byte();
        if (high & 0x80) {
            last_ = static_cast<uint16_t>(last_ + kLargeMiddle - high);
        } else {
            last_ = static_cast<uint16_t>(high << 8 | byte());
        }
        put();
    }

    void put() {
        if (values_.size() == count_) throw Error("holds more than ", count_, " values");
        if (!table_.empty() && last_ >= table_.size())
            throw Error("names value ", last_, " of a table of ", table_.size());
        values_.push_back(table_.empty() ? last_ : table_[last_]);
    }

    uint32_t byte() {
        if (at_ == bytes_.size()) throw Error("ends after ", values_.size(), " of ", count_, " values");
        return bytes_[at_++];
    }

    uint16_t word() {
        const uint32_t low = byte();
        return static_cast<uint16_t>(low | byte() << 8);
    }

    std::span<const uint8_t> bytes_;
    size_t at_ = 0, count_;
    std::vector<uint16_t> table_, values_;
    uint16_t last_ = 0;  // the codec counts in 16 bits
};

}  // namespace

std::vector<uint16_t> decode_oni_depth(std::span<const uint8_t> bytes, size_t count, bool has_table) {
    return Decoder(bytes, count, has_table).decode();
}

}  // namespace patina::sensor
