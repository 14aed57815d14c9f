// In place of the viewer where this program was built without what it needs.

#include "engine/core/error.h"
#include "tools/viewer/viewer_options.h"

namespace patina::tools {

namespace {

[[noreturn]] void fail() {
    throw Error("this patina has no viewer: ", PATINA_VIEWER_LACKS,
                " was not installed when it was built (tools/setup installs it)");
}

}  // namespace

void view(const ViewOptions&) { fail(); }

std::unique_ptr<RunCompanion> show_run(const ViewerOptions&, const RunOptions&, RunCompanion*, LiveControls*) {
    fail();
}

}  // namespace patina::tools
