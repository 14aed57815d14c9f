#include "tests/gpu/gpu_test.h"

#include <cstdlib>

namespace patina {

vulkan::Device& GpuTest::device() {
    static vulkan::Device device([] {
        const char* selector = std::getenv("PATINA_DEVICE");
        vulkan::DeviceOptions options;
        options.selector = selector ? selector : "";
        options.validation = true;
        return options;
    }());
    return device;
}

void GpuTest::SetUp() { messages_before_ = device().validation_messages().size(); }

void GpuTest::TearDown() {
    runner_.wait();
    const auto messages = device().validation_messages();
    for (size_t i = messages_before_; i < messages.size(); ++i) ADD_FAILURE() << messages[i];
}

void GpuTest::run(graph::FrameGraph frame) {
    runner_.submit(std::move(frame));
    runner_.wait();
    const graph::CompiledFrame& compiled = runner_.last_frame();
    EXPECT_THAT(graph::check(compiled.description, compiled.plan), ::testing::IsEmpty());
    EXPECT_THAT(graph::find_unneeded_barriers(compiled.description, compiled.plan), ::testing::IsEmpty());
}

}  // namespace patina
