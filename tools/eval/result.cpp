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
    }
    PATINA_ASSERT(false, "quantity ", static_cast<int>(quantity));
}

int channels_of(Quantity quantity) { return quantity == Quantity::kAlpha ? 1 : 3; }

}  // namespace patina::eval
