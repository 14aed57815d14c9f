#include "tests/gpu/gpu_test.h"

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <vector>

namespace patina {

namespace {

std::unique_ptr<vulkan::Device> open_device() {
    const char* selector = std::getenv("PATINA_DEVICE");
    vulkan::DeviceOptions options;
    options.selector = selector ? selector : "";
    options.validation = true;
    return std::make_unique<vulkan::Device>(options);
}

struct SharedDevice {
    std::unique_ptr<vulkan::Device> device = open_device();
    bool lost = false;
    size_t reported = 0;  ///< messages of the validation layer that failed a test
};

SharedDevice& shared() {
    static SharedDevice shared;
    return shared;
}

/// Fails for what the validation layer said since the last call: before, during and after a test.
void report_messages() {
    const auto messages = shared().device->validation_messages();
    for (; shared().reported < messages.size(); ++shared().reported) ADD_FAILURE() << messages[shared().reported];
}

/// What the last test's runner caused when it ended.
class AfterAllTests : public ::testing::Environment {
  public:
    void TearDown() override {
        if (opened) report_messages();
    }
    static inline bool opened = false;
};
[[maybe_unused]] const auto* const kAfterAllTests = ::testing::AddGlobalTestEnvironment(new AfterAllTests);

/// The shared device for a new test. Nothing of the test before is left, so that a lost one can be replaced.
vulkan::Device& usable_device() {
    AfterAllTests::opened = true;
    if (shared().lost) {
        report_messages();
        shared().device.reset();
        shared() = {};
    }
    return *shared().device;
}

/// A frame's plan depends on its description alone: frames of one description are checked once in a process.
bool first_of_its_kind(const graph::Description& description) {
    static std::vector<graph::Description> checked;
    if (std::ranges::find(checked, description) != checked.end()) return false;
    checked.push_back(description);
    return true;
}

}  // namespace

GpuTest::GpuTest() : runner_(usable_device()) {}

vulkan::Device& GpuTest::device() { return *shared().device; }

void GpuTest::TearDown() {
    try {
        runner_.wait();
        device().wait_idle();
    } catch (const Error& error) {
        ADD_FAILURE() << error.what();
        shared().lost = true;
    }
    report_messages();
}

void GpuTest::run(graph::FrameGraph frame) {
    runner_.submit(std::move(frame));
    runner_.wait();
    const graph::CompiledFrame& compiled = runner_.last_frame();
    if (!first_of_its_kind(compiled.description)) return;
    EXPECT_THAT(graph::check(compiled.description, compiled.plan), ::testing::IsEmpty());
    EXPECT_THAT(graph::find_unneeded_barriers(compiled.description, compiled.plan), ::testing::IsEmpty());
}

}  // namespace patina
