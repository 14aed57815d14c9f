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
};

SharedDevice& shared() {
    static SharedDevice shared;
    return shared;
}

/// The shared device for a new test. Nothing of the test before is left, so that a lost one can be replaced.
vulkan::Device& usable_device() {
    if (shared().lost) {
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

void GpuTest::SetUp() { messages_before_ = device().validation_messages().size(); }

void GpuTest::TearDown() {
    try {
        runner_.wait();
        device().wait_idle();
    } catch (const Error& error) {
        ADD_FAILURE() << error.what();
        shared().lost = true;
    }
    const auto messages = device().validation_messages();
    for (size_t i = messages_before_; i < messages.size(); ++i) ADD_FAILURE() << messages[i];
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
