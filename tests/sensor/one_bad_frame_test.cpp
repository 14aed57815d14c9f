#include <functional>
#include <new>
#include <stdexcept>

#include <gmock/gmock.h>
#include <sys/stat.h>

#include "sensor/open.h"
#include "sensor/readers/folder_source.h"
#include "tests/sensor/sequences.h"

// What one frame's files may cost: that frame. What a sequence says of itself is compared with its files.

namespace patina::sensor::one_bad_frame_test {
namespace {

using namespace testing;
using ::testing::AllOf;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

/// A source of which one frame throws what no reader of ours does.
class ThrowingSource : public FolderSource {
  public:
    explicit ThrowingSource(std::function<void()> action) : action_(std::move(action)) { info_.frames = 2; }

  private:
    Frame decode(uint32_t index) const override {
        if (index == 0) action_();
        return test_frame(index, {4, 4}, {4, 4});
    }

    std::function<void()> action_;
};

TEST(FolderSource, WhateverDecodingThrowsCostsItsFrame) {
    const auto reason = [](std::function<void()> action) {
        ThrowingSource source(std::move(action));
        const std::vector<Reading> readings = read_all(source);
        EXPECT_EQ(readings.size(), 2u);
        EXPECT_TRUE(std::holds_alternative<Frame>(readings.at(1)));
        return std::get<Skipped>(readings.at(0)).reason;
    };
    EXPECT_EQ(reason([] { throw std::bad_alloc(); }), "frame 0 cannot be decoded: there is not enough memory");
    EXPECT_EQ(reason([] { throw std::runtime_error("its own words"); }), "frame 0 cannot be decoded: its own words");
}

TEST(NativeReader, ALinkThatLeadsToItselfCostsItsFrame) {
    const TemporaryFolder folder;
    write_native(folder / "a", 3);
    fs::remove(folder / "a/color/000001.png");
    fs::create_symlink("000001.png", folder / "a/color/000001.png");
    EXPECT_THAT(only_skip_reason(folder / "a", 1),
                AllOf(HasSubstr("color/000001.png cannot be read"), HasSubstr("symbolic links")));
}

TEST(NativeReader, APipeInPlaceOfAPictureCostsItsFrame) {
    const TemporaryFolder folder;
    write_native(folder / "a", 3);
    fs::remove(folder / "a/depth/000001.png");
    ASSERT_EQ(mkfifo((folder / "a/depth/000001.png").c_str(), 0600), 0);
    EXPECT_THAT(only_skip_reason(folder / "a", 1), HasSubstr("depth/000001.png is a pipe, not a file"));
}

TEST(NativeReader, FramesAreCountedAgainstTheFiles) {
    const TemporaryFolder folder;
    write_native(folder / "a", 3);
    fs::remove(folder / "a/timestamps.txt");
    replace_text(folder / "a/sequence.json", "\"frames\": 3", "\"frames\": 7");
    EXPECT_EQ(read_all(*open_sequence(folder / "a")).size(), 7u) << "missing frames are skipped one by one";
    replace_text(folder / "a/sequence.json", "\"frames\": 7", "\"frames\": 1000000000");
    EXPECT_EQ(error_of([&] { open_sequence(folder / "a"); }),
              (folder / "a/sequence.json").string() + ": frames is 1000000000, but color/ holds 3 files and depth/ 3");
}

TEST(NativeReader, CamerasThatNobodyHasAreErrors) {
    const TemporaryFolder folder;
    write_native(folder / "a", 1);
    replace_text(folder / "a/sequence.json", "\"width\": 32", "\"width\": 4000000000");
    EXPECT_THAT(error_of([&] { open_sequence(folder / "a"); }),
                HasSubstr("sequence.json: color is 4000000000 x 24 pixels, at most 134217728 are decoded"));
}

TEST(TumReader, ANameThatIsTooLongCostsItsFrame) {
    const TemporaryFolder folder;
    write_tum(folder / "a", 3);
    replace_text(folder / "a/depth.txt", "depth/000001.png", "depth/" + std::string(300, 'x') + ".png");
    EXPECT_THAT(only_skip_reason(folder / "a", 1), HasSubstr("x.png cannot be read: File name too long"));
}

}  // namespace
}  // namespace patina::sensor::one_bad_frame_test
