#include "engine/core/printable.h"

#include <gtest/gtest.h>

namespace patina::printable_test {
namespace {

TEST(Printable, TextStaysAsItIs) {
    for (const char* text : {"", "a/b c.png", "Büro 3 – «Küche»", "日本語", "😀", "back\\slash"})
        EXPECT_EQ(printable(text), text);
}

TEST(Printable, WhatSteersATerminalIsWrittenAsItsBytes) {
    EXPECT_EQ(printable("a\033[31mb"), "a\\x1b[31mb");
    EXPECT_EQ(printable("a\rb\nc\td\b\x7f"), "a\\x0db\\x0ac\\x09d\\x08\\x7f");
    EXPECT_EQ(printable(std::string("a\0b", 3)), "a\\x00b");
    EXPECT_EQ(printable("\xc2\x9b"
                        "31m"),
              "\\xc2\\x9b31m")
        << "U+009B begins a sequence, too";
    EXPECT_EQ(printable("a\xe2\x80\xae"
                        "b"),
              "a\\xe2\\x80\\xaeb")
        << "U+202E turns the line round";
    EXPECT_EQ(printable("a\xe2\x81\xa6"
                        "b"),
              "a\\xe2\\x81\\xa6"
              "b")
        << "U+2066 likewise";
}

TEST(Printable, WhatIsNoUtf8IsWrittenAsItsBytes) {
    EXPECT_EQ(printable("caf\xe9.png"), "caf\\xe9.png") << "Latin-1";
    EXPECT_EQ(printable("\xff\xfe"), "\\xff\\xfe");
    EXPECT_EQ(printable("a\xc3"), "a\\xc3") << "cut off";
    EXPECT_EQ(printable("\xc0\x9b"), "\\xc0\\x9b") << "longer than needed";
    EXPECT_EQ(printable("\xe0\x80\x9b"), "\\xe0\\x80\\x9b") << "longer than needed";
    EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80") << "half of a pair";
    EXPECT_EQ(printable("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80") << "beyond Unicode";
    EXPECT_EQ(printable("\xe2\x82Z"), "\\xe2\\x82Z") << "what follows a broken character is kept";
}

TEST(Printable, LinesKeepTheirEndsAlone) { EXPECT_EQ(printable_lines("a\033b\nc\r\n"), "a\\x1bb\nc\\x0d\n"); }

}  // namespace
}  // namespace patina::printable_test
