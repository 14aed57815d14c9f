#pragma once

#include <string>
#include <string_view>

namespace patina {

/// Text from outside (file names, names in files, messages of libraries) for a terminal. Bytes that could steer it are
/// written as \xNN: control characters, those of Unicode (U+0080 to U+009F) and those that turn the direction of
/// writing, and bytes that are no UTF-8. All other text stays as it is.
std::string printable(std::string_view text);

/// The same line by line: line feeds stay.
std::string printable_lines(std::string_view text);

}  // namespace patina
