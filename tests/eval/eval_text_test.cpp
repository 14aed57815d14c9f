#include "tools/eval/eval_text.h"

#include <algorithm>
#include <sstream>

#include <gmock/gmock.h>

#include "tests/eval/made_up_evaluation.h"

namespace patina::eval {
namespace {

TEST(EvalText, Prints) {
    std::fputs(eval_text(test::full_evaluation()).c_str(), stdout);
    std::fputs(eval_text(test::geometry_only()).c_str(), stdout);
    std::fputs(eval_text(test::full_evaluation(9)).c_str(), stdout);
}

}  // namespace
}  // namespace patina::eval
