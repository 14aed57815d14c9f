#include "sensor/files/text_file.h"

#include <cmath>

#include <gmock/gmock.h>

#include "tests/sensor/sequences.h"

namespace patina::sensor::text_file_test {
namespace {

using namespace testing;
using ::testing::HasSubstr;

TEST(TextFile, SplitsLinesAndLeavesOutComments) {
    const TemporaryFolder folder;
    write_text(folder / "a.txt", "# head\n1 2\r\n\n  3\t4e-1 # tail\n#\n+5");
    const std::vector<TextLine> lines = read_lines(folder / "a.txt");
    ASSERT_EQ(lines.size(), 3u);
    EXPECT_EQ(lines[0].index(1), 2u);
    EXPECT_EQ(lines[1].where(), (folder / "a.txt").string() + ":4");
    EXPECT_EQ(lines[1].number(1), 0.4);
    EXPECT_EQ(lines[2].number(0), 5);
}

TEST(TextFile, NumbersAreStrict) {
    const TextLine line("f:1", {"1.5x", "1,5", "0x10", "", "--1", "1e999", "nan", "-inf", "4294967296", "1.0"});
    for (size_t column = 0; column < 6; ++column) {
        EXPECT_THAT(error_of([&] { line.number(column); }),
                    HasSubstr(text("f:1: '", line.word(column), "' in column ")));
    }
    EXPECT_TRUE(std::isnan(line.number(6)));
    EXPECT_EQ(line.number(7), -INFINITY);
    EXPECT_EQ(error_of([&] { line.finite(7); }), "f:1: column 8 is -inf, must be finite");
    EXPECT_THAT(error_of([&] { line.index(8); }), HasSubstr("is not a whole number from 0"));
    EXPECT_THAT(error_of([&] { line.index(9); }), HasSubstr("is not a whole number from 0"));
}

TEST(TextFile, FilesThatCannotBeReadAreNamed) {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "d");
    EXPECT_EQ(error_of([&] { read_lines(folder / "none"); }), (folder / "none").string() + " does not exist");
    EXPECT_EQ(error_of([&] { read_lines(folder / "d"); }), (folder / "d").string() + " is a folder, not a file");
    EXPECT_EQ(error_of([&] { write_bytes(folder / "no/f", "x"); }),
              (folder / "no/f").string() + " cannot be written: No such file or directory");
}

TEST(TextFile, ShortestReadsBackTheSameNumber) {
    for (const double value : {0.1, 1.0 / 3, 1e-300, -2.5e17, 1305031102.175304}) {
        EXPECT_EQ(TextLine("", {shortest(value)}).number(0), value);
    }
    EXPECT_EQ(fixed(2.0 / 3, 2), "0.67");
}

}  // namespace
}  // namespace patina::sensor::text_file_test
