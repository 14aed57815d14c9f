#pragma once

#include <string>

#include "tools/eval/result.h"

namespace patina::eval {

/// The text of eval.json: an evaluation, its keys in the order of docs/guide/evaluation.md; lists of numbers stand on
/// one line. What was not measured is null, and so is a PSNR that is infinite because nothing differs. Numbers have all
/// their digits: reading them gives the same doubles. Text that is not UTF-8 has its bad bytes replaced.
std::string eval_json(const Evaluation& evaluation);

}  // namespace patina::eval
