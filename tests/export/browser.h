#pragma once

#include <cstdlib>
#include <fstream>
#include <string>

#include "tests/export/temporary_folder.h"

namespace patina::test {

/// Whether there is a browser for browser_dom().
inline bool has_browser() { return std::system("command -v chromium > /dev/null") == 0; }

/// What a page has become after ten seconds of its own time in headless Chromium, as HTML: it is opened as a file of
/// `folder`. Empty where the browser failed.
inline std::string browser_dom(const TemporaryFolder& folder, const std::string& html) {
    std::ofstream(folder / "page.html") << html;
    const std::string line =
        "timeout 300 chromium --headless=new --no-sandbox --use-angle=swiftshader --enable-unsafe-swiftshader "
        "--allow-file-access-from-files --user-data-dir=" +
        (folder / "profile").string() + " --virtual-time-budget=10000 --dump-dom file://" +
        (folder / "page.html").string() + " > " + (folder / "dom").string() + " 2> /dev/null";
    return std::system(line.c_str()) == 0 ? bytes_of(folder / "dom") : std::string();
}

}  // namespace patina::test
