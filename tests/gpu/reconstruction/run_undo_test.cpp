// A run whose user goes back to an earlier model, with pictures that are held out.

#include <nlohmann/json.hpp>

#include "engine/store/temporary_database.h"
#include "tests/export/temporary_folder.h"
#include "tests/gpu/reconstruction/office_session.h"
#include "tools/run/run.h"

namespace patina::run_undo_test {
namespace {

/// Frames of the small office; the first is damaged.
class DamagedAtFirst : public Source {
  public:
    DamagedAtFirst(const SmallOffice& office, uint32_t frames) : office_(office), info_(office.info), frames_(frames) {
        info_.frames = frames;
    }
    const SequenceInfo& info() const override { return info_; }
    std::optional<Reading> next() override {
        if (next_ == frames_) return std::nullopt;
        const uint32_t index = next_++;
        if (index == 0) return Skipped{0, "it is damaged"};
        Frame frame = office_.frames[index];
        frame.index = index;
        return frame;
    }

  private:
    const SmallOffice& office_;
    SequenceInfo info_;
    uint32_t frames_, next_ = 0;
};

/// Keeps the model after one frame, and goes back to it after another.
class GoesBack : public tools::RunCompanion {
  public:
    GoesBack(std::unique_ptr<Source> source, uint32_t from, uint32_t to)
        : source_(std::move(source)), from_(from), to_(to) {}
    std::unique_ptr<Source> source(vulkan::Device&) override { return std::move(source_); }
    void adjust(SessionCallbacks&) override {}
    void after_step(SessionCore& session) override {
        if (const Frame* frame = session.fused()) {
            const uint32_t index = frame->index;
            if (index == to_) session.keep_model(kept_);
            if (index == from_) session.go_back(kept_);
        }
    }
    void end() override {}
    std::vector<std::string> shortfalls() const override { return {}; }
    void add_to(RunSummary&) const override {}

  private:
    std::unique_ptr<Source> source_;
    uint32_t from_, to_;
    MapFile kept_{temporary_database("patina-test")};
};

class RunUndoTest : public OfficeSessionTest {};

TEST_F(RunUndoTest, HeldOutPicturesAreThoseThatWereNotUndone) {
    const test::TemporaryFolder folder;
    tools::RunOptions options;
    static_cast<SessionOptions&>(options) = office_options("1024");
    options.out = folder / "out";
    options.texture = false;
    options.quiet = true;
    options.hold_out = 2;
    // Every odd one is held out: 1 before a frame was fused, 5 between the checkpoint and the next one that was.
    GoesBack companion(std::make_unique<DamagedAtFirst>(*office_, 9), 6, 4);
    tools::run(options, &companion);
    const auto summary = nlohmann::json::parse(test::bytes_of(options.out / "run.json"));
    EXPECT_EQ(summary["frames"]["used"], 6);
    EXPECT_EQ(summary["frames"]["undone"], 2);
    EXPECT_EQ(summary["held_out"]["pictures"], 3);
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(options.out / "held_out"))
        names.push_back(entry.path().filename().string());
    EXPECT_THAT(names, ::testing::UnorderedElementsAre("000001.png", "000003.png", "000007.png", "scores.txt"));
}

}  // namespace
}  // namespace patina::run_undo_test
