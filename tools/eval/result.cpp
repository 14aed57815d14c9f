#include "tools/eval/result.h"

#include "engine/core/error.h"

namespace patina::eval {

const char* name_of(Quantity quantity) {
    switch (quantity) {
        case Quantity::kKdBefore: return "kd_before";
        case Quantity::kKd: return "kd";
        case Quantity::kKs: return "ks";
        case Quantity::kAlpha: return "alpha";
        case Quantity::kRgbBefore: return "rgb_before";
        case Quantity::kRgb: return "rgb";
        case Quantity::kKdShown: return "kd_shown";
        case Quantity::kRgbShown: return "rgb_shown";
    }
    PATINA_ASSERT(false, "quantity ", static_cast<int>(quantity));
}

const char* name_of(Pixels pixels) {
    switch (pixels) {
        case Pixels::kAll: return "all";
        case Pixels::kFilled: return "filled";
        case Pixels::kSeen: return "seen";
    }
    PATINA_ASSERT(false, "pixels ", static_cast<int>(pixels));
}

const Scores* Comparison::over(Pixels pixels) const {
    if (pixels == Pixels::kAll) return &all;
    const std::optional<Scores>& scores = pixels == Pixels::kFilled ? filled : seen;
    return scores ? &*scores : nullptr;
}

int channels_of(Quantity quantity) { return quantity == Quantity::kAlpha ? 1 : 3; }

}  // namespace patina::eval
