#include "tools/program/outcome.h"

#include "engine/core/printable.h"
#include "tools/program/standard_streams.h"

namespace patina::tools {

void Outcome::print(bool quiet) const {
    for (const std::string& sentence : shortfalls_) {
        if (quiet) {
            print_error("patina: {}\n", printable(sentence));
        } else {
            print_out("incomplete: {}\n", printable(sentence));
        }
    }
}

}  // namespace patina::tools
