#include "tools/report/video.h"

#include <gmock/gmock.h>
#include <opencv2/videoio.hpp>

#include "tests/export/temporary_folder.h"
#include "tests/export/throws.h"
#include "tests/support/file_size_limit.h"

namespace patina::video_test {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;
using test::throws_error_with;

constexpr Extent2D kExtent{64, 48};
const Drawing kRed(kExtent, {200, 30, 10}), kBlue(kExtent, {10, 30, 200});

TEST(Video, HoldsItsFramesInOrder) {
    const TemporaryFolder folder;
    VideoWriter video(folder / "a.avi", kExtent, 25);
    for (const Drawing& frame : {kRed, kBlue, kBlue}) video.write(frame);
    EXPECT_FALSE(fs::exists(folder / "a.avi")) << "not before it is whole";
    video.finish();

    cv::VideoCapture capture((folder / "a.avi").string());
    ASSERT_TRUE(capture.isOpened());
    EXPECT_EQ(capture.get(cv::CAP_PROP_FPS), 25);
    std::vector<cv::Vec3b> middles;
    for (cv::Mat frame; capture.read(frame);) middles.push_back(frame.at<cv::Vec3b>(24, 32));
    ASSERT_EQ(middles.size(), 3u);
    EXPECT_GT(middles[0][2], middles[0][0] + 100) << "red first";
    EXPECT_GT(middles[1][0], middles[1][2] + 100);
    EXPECT_GT(middles[2][0], middles[2][2] + 100);
}

TEST(Video, Mp4IsWhatBrowsersPlay) {
    const TemporaryFolder folder;
    VideoWriter video(folder / "a.mp4", kExtent, 25);
    for (int i = 0; i < 10; ++i) video.write(i < 5 ? kRed : kBlue);
    video.finish();
    cv::VideoCapture capture((folder / "a.mp4").string());
    ASSERT_TRUE(capture.isOpened());
    const int codec = static_cast<int>(capture.get(cv::CAP_PROP_FOURCC));
    EXPECT_THAT(codec, testing::AnyOf(cv::VideoWriter::fourcc('a', 'v', 'c', '1'),
                                      cv::VideoWriter::fourcc('h', '2', '6', '4')));
    size_t frames = 0;
    for (cv::Mat frame; capture.read(frame);) ++frames;
    EXPECT_EQ(frames, 10u);
}

TEST(Video, OneThatIsNotFinishedLeavesNothing) {
    const TemporaryFolder folder;
    { VideoWriter(folder / "a.avi", kExtent, 25).write(kRed); }
    EXPECT_TRUE(fs::is_empty(folder.path()));
}

/// The encoder itself reports nothing.
TEST(Video, NoticesAFullDisk) {
    const TemporaryFolder folder;
    VideoWriter video(folder / "a.avi", kExtent, 25);
    const test::FileSizeLimit limit(3000);
    for (int i = 0; i < 50; ++i) video.write(i % 2 ? kRed : kBlue);
    EXPECT_THAT([&] { video.finish(); }, throws_error_with("but 50 were written: is there no space left on the disk?"));
    EXPECT_FALSE(fs::exists(folder / "a.avi"));
}

TEST(Video, SaysWhatItCannotWrite) {
    const TemporaryFolder folder;
    EXPECT_THAT([&] { VideoWriter(folder / "a.gif", kExtent, 25); }, throws_error_with("must be a .avi or a .mp4"));
    EXPECT_THAT([&] { VideoWriter(folder / "none/a.avi", kExtent, 25); }, throws_error_with("there is no folder"));
    fs::create_directory(folder / "b.avi");
    EXPECT_THAT([&] { VideoWriter(folder / "b.avi", kExtent, 25); }, throws_error_with("it is a folder"));
}

}  // namespace
}  // namespace patina::video_test
