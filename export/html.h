#pragma once

#include <string>
#include <string_view>

namespace patina {

/// The text with the five characters that mean something to HTML replaced, for elements and quoted attributes alike.
std::string html_escaped(std::string_view text);

/// RFC 4648 base64, padded.
std::string base64(std::string_view bytes);

}  // namespace patina
