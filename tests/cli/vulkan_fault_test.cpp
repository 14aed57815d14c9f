#include "sensor/truth.h"
#include "tests/cli/run_folder.h"

// Vulkan calls that fail, each once, somewhere in a run with lights: one sentence, and nothing but whole files.

namespace patina::testing::vulkan_fault_test {
namespace {

using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr int kOutOfHostMemory = -1, kOutOfDeviceMemory = -2, kDeviceLost = -4;

class VulkanFault : public RunFolderTest {
  protected:
    VulkanFault() { sensor::write_lights(lights_, std::vector<Light>{{{0, -1.5, 0}, glm::dvec3(8)}}); }

    Outcome run_with(const std::string& call, int at, int result) const {
        return patina({"run", sequence(), "--out", out(), "--quiet", "--lights", lights_, "--dump-every", "1",
                       "--texture", "off"},
                      {{"VK_LAYER_PATH", PATINA_FAULT_LAYER_FOLDER},
                       {"VK_INSTANCE_LAYERS", "VK_LAYER_PATINA_fault"},
                       {"PATINA_FAULT", call + ' ' + std::to_string(at) + ' ' + std::to_string(result)}});
    }

    void expect_no_partial_files() const {
        for (const auto& [name, content] : files_in(beside("."))) EXPECT_THAT(name, Not(HasSubstr("partial")));
    }

  private:
    const std::filesystem::path lights_ = beside("lights.json");
};

TEST_F(VulkanFault, OfEachKindIsOneSentence) {
    const std::vector<std::pair<const char*, int>> calls{
        {"vkAllocateCommandBuffers", 1}, {"vkAllocateMemory", 1},   {"vkBeginCommandBuffer", 2},
        {"vkBindBufferMemory", 20},      {"vkCreateBuffer", 20},    {"vkCreateComputePipelines", 3},
        {"vkCreateDescriptorPool", 1},   {"vkCreateImageView", 1},  {"vkCreateSemaphore", 1},
        {"vkEndCommandBuffer", 1},       {"vkMapMemory", 1},        {"vkQueueSubmit2", 1},
        {"vkQueueSubmit2", 3},           {"vkResetCommandPool", 2}, {"vkWaitSemaphores", 2}};
    for (const auto& [call, at] : calls) {
        SCOPED_TRACE(call + (' ' + std::to_string(at)));
        EXPECT_THAT(expect_failure(run_with(call, at, kOutOfHostMemory)), HasSubstr("host ran out of memory while"));
        expect_no_partial_files();
    }
}

TEST_F(VulkanFault, LackOfDeviceMemoryNamesWhatWasAllocated) {
    for (const int at : {2, 30}) {
        EXPECT_THAT(expect_failure(run_with("vkAllocateMemory", at, kOutOfDeviceMemory)),
                    HasSubstr("device ran out of memory while allocating"));
        expect_no_partial_files();
    }
}

TEST_F(VulkanFault, ALostDeviceEndsTheRun) {
    for (const char* call : {"vkQueueSubmit2", "vkWaitSemaphores"}) {
        SCOPED_TRACE(call);
        EXPECT_THAT(expect_failure(run_with(call, 3, kDeviceLost)), HasSubstr("the Vulkan device was lost while"));
        expect_no_partial_files();
    }
}

TEST_F(VulkanFault, ALostDeviceLeavesWhatTheHostHas) {
    EXPECT_THAT(expect_failure(run_with("vkQueueSubmit2", 5, kDeviceLost)),
                AllOf(HasSubstr("the Vulkan device was lost while"), HasSubstr("holds what could still be written")));
    const nlohmann::json summary = summary_of(out());
    EXPECT_EQ(summary["finished"], false);
    EXPECT_THAT(summary.value("ended", ""), HasSubstr("the Vulkan device was lost"));
    EXPECT_GT(summary["frames"]["used"], 0);
    EXPECT_TRUE(std::filesystem::exists(out() / "trajectory.txt"));
    EXPECT_THAT(sensor::testing::read_text(out() / "report.html"), HasSubstr("the Vulkan device was lost"));
}

TEST_F(VulkanFault, PassTimesThePipelineCacheAndADescriptorPoolAreNoReasonToFail) {
    for (const char* call : {"none", "vkGetQueryPoolResults", "vkGetPipelineCacheData", "vkAllocateDescriptorSets"}) {
        const Outcome outcome = run_with(call, 2, kOutOfHostMemory);
        EXPECT_THAT(outcome.exit_code, AnyOf(0, 3)) << call << ": " << outcome.err;
        EXPECT_TRUE(std::filesystem::exists(out() / "scene.glb")) << call;
    }
}

}  // namespace
}  // namespace patina::testing::vulkan_fault_test
