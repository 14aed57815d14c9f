#pragma once

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/graph/plan/mutate.h"
#include "engine/graph/runner.h"
#include "engine/vulkan/device.h"

namespace patina {

/// Opens one device per test program, as PATINA_DEVICE says, with validation and synchronization validation, and fails
/// any test during or before which the validation layer reported something. A test that lost the device fails, and the
/// next one opens it anew. Every kind of frame that tests submit through run() is also shown to the graph's own
/// checker, and each of its barriers must be needed.
class GpuTest : public ::testing::Test {
  protected:
    GpuTest();

    void TearDown() override;

    static vulkan::Device& device();
    graph::Runner& runner() { return runner_; }

    /// Submits and waits.
    void run(graph::FrameGraph frame);

  private:
    graph::Runner runner_;
};

}  // namespace patina
