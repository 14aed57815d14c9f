#include "engine/graph/runner.h"

#include <chrono>
#include <deque>
#include <list>
#include <utility>

#include "engine/graph/record.h"
#include "engine/vulkan/context.h"

namespace patina::graph {

namespace {

constexpr uint32_t kFramesInFlight = 2;
constexpr size_t kCachedShapes = 16;          // run loops alternate between a handful of shapes
constexpr uint32_t kTimedPasses = 256;        // at first
constexpr uint64_t kStagingBlock = 4u << 20;  // one 640 x 480 frame fits

/// Host-visible memory handed out front to back and reused as a whole once its frame has finished.
class StagingArena {
  public:
    StagingArena(vulkan::Device& device, vulkan::MemoryKind kind, std::string name)
        : device_(device), kind_(kind), name_(std::move(name)) {}

    Staging take(uint64_t bytes) {
        const uint64_t aligned = (bytes + 15) / 16 * 16;
        while (block_ < blocks_.size() && used_ + aligned > blocks_[block_]->bytes()) {
            ++block_;
            used_ = 0;
        }
        if (block_ == blocks_.size()) {
            blocks_.push_back(device_.create_buffer({name_, std::max(aligned, kStagingBlock), kind_}));
        }
        const Staging staging{blocks_[block_], used_, blocks_[block_]->mapped() + used_};
        used_ += aligned;
        return staging;
    }

    void reset() { block_ = used_ = 0; }

  private:
    vulkan::Device& device_;
    vulkan::MemoryKind kind_;
    std::string name_;
    std::vector<vulkan::BufferRef> blocks_;
    size_t block_ = 0;
    uint64_t used_ = 0;
};

size_t hash_of(const Description& description) {
    size_t hash = 1469598103934665603u;
    const auto mix = [&](uint64_t value) { hash = (hash ^ value) * 1099511628211u; };
    for (const Resource& resource : description.resources) mix(resource.need.bytes * 2 + resource.imported);
    for (const Pass& pass : description.passes) {
        mix(std::hash<std::string>{}(pass.name));
        for (const Access& access : pass.accesses) mix(access.resource * 16u + static_cast<uint32_t>(access.use));
    }
    return hash;
}

double milliseconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

/// What one frame in flight owns.
struct Slot {
    Slot(vulkan::Device& device, uint32_t index);

    vk::raii::CommandPool pool;
    vk::raii::CommandBuffer commands = nullptr;
    vk::raii::QueryPool queries = nullptr;  ///< null without timestamps
    uint32_t timed_capacity = 0;            ///< passes whose queries fit
    StagingArena upload;
    StagingArena download;
    uint64_t submitted = 0;                 ///< timeline value of its last frame
    std::vector<std::string> timed_passes;  ///< pass i used queries 2i and 2i + 1
    std::vector<PendingRead> reads;
    std::vector<FrameGraph::Physical> resources;  ///< kept alive until the frame has finished
    std::shared_ptr<const Transients> transients;
    FrameTime time;  ///< of its last frame

    /// Makes room for the times of as many passes; nothing of the slot is in flight.
    void hold_times_of(const vulkan::Context& context, uint32_t passes);

    /// Forgets a frame that was recorded and could not be submitted: its read-backs never become ready.
    void drop_recording() {
        reads.clear();
        timed_passes.clear();
    }
};

Slot::Slot(vulkan::Device& device, uint32_t index)
    : pool(device.context().device(),
           vk::CommandPoolCreateInfo(vk::CommandPoolCreateFlagBits::eTransient, device.context().queue_family())),
      upload(device, vulkan::MemoryKind::kUpload, text("upload.", index)),
      download(device, vulkan::MemoryKind::kReadback, text("read_back.", index)) {
    const vulkan::Context& context = device.context();
    vk::raii::CommandBuffers made(context.device(), {*pool, vk::CommandBufferLevel::ePrimary, 1});
    commands = std::move(made.front());
    context.set_name(pool, text("frame.", index, ".pool"));
    context.set_name(commands, text("frame.", index));
    hold_times_of(context, kTimedPasses);
}

void Slot::hold_times_of(const vulkan::Context& context, uint32_t passes) {
    if (!context.caps().timestamps || passes <= timed_capacity) return;
    const uint32_t most = std::max(passes, 2 * timed_capacity);
    queries = context.device().createQueryPool({{}, vk::QueryType::eTimestamp, 2 * most});
    context.set_name(queries, "frame.timestamps");
    timed_capacity = most;
}

/// A compiled shape with its transient resources.
struct CachedShape {
    size_t hash = 0;
    std::shared_ptr<const CompiledFrame> compiled;
    TransientSizes sizes;
    std::shared_ptr<const Transients> transients;  ///< null until the shape is used in the memory there is now
};

struct Runner::State {
    explicit State(vulkan::Device& device) : descriptors(device) {}

    vk::raii::Semaphore timeline = nullptr;
    uint64_t submitted = 0;
    std::vector<std::unique_ptr<Slot>> slots;
    Slot* current = nullptr;
    std::list<CachedShape> shapes;  ///< most recently used first
    TransientMemory memory;
    DescriptorCache descriptors;
    std::vector<Timing> timings;
    std::unordered_map<std::string, size_t> timing_index;
    Timing host{"graph.submit", {}};
    uint32_t compilations = 0;
    std::shared_ptr<const CompiledFrame> last = std::make_shared<CompiledFrame>();

    Timing& timing(const std::string& name) {
        const auto [found, fresh] = timing_index.try_emplace(name, timings.size());
        if (fresh) timings.push_back({name, {}});
        return timings[found->second];
    }
};

Runner::Runner(vulkan::Device& device) : device_(device), state_(std::make_unique<State>(device)) {
    vulkan::guarded("preparing to run frames", [&] {
        vk::SemaphoreTypeCreateInfo type(vk::SemaphoreType::eTimeline, 0);
        vk::SemaphoreCreateInfo info;
        info.pNext = &type;
        state_->timeline = device.context().device().createSemaphore(info);
        device.context().set_name(state_->timeline, "graph.timeline");
        for (uint32_t i = 0; i < kFramesInFlight; ++i) state_->slots.push_back(std::make_unique<Slot>(device, i));
    });
}

Runner::~Runner() {
    try {
        device_.wait_idle();
    } catch (const std::exception&) {
        // A lost device has nothing left to wait for; whoever submitted to it has been told.
    }
}

namespace {

/// Adds the times of the slot's frame. Those that the device cannot give are left out; only a lost device throws.
void collect_times(Runner::State& state, const vulkan::Context& context, Slot& slot) {
    const std::vector<std::string> passes = std::exchange(slot.timed_passes, {});
    if (passes.empty()) return;
    const uint32_t count = static_cast<uint32_t>(passes.size()) * 2;
    std::vector<uint64_t> ticks;
    try {
        auto [result, read] = slot.queries.getResults<uint64_t>(0, count, count * sizeof(uint64_t), sizeof(uint64_t),
                                                                vk::QueryResultFlagBits::e64);
        if (result != vk::Result::eSuccess) return;
        ticks = std::move(read);
    } catch (const vk::DeviceLostError&) {
        throw;
    } catch (const vk::SystemError&) {
        return;
    }
    for (size_t i = 0; i < passes.size(); ++i) {
        const double ns = static_cast<double>(ticks[2 * i + 1] - ticks[2 * i]) * context.caps().timestamp_period_ns;
        state.timing(passes[i]).samples_ms.push_back(static_cast<float>(ns * 1e-6));
    }
    slot.time.deliver(static_cast<double>(ticks.back() - ticks.front()) * context.caps().timestamp_period_ns * 1e-6);
}

/// Waits for the slot's last frame and takes what it brought.
void retire(Runner::State& state, const vulkan::Context& context, Slot& slot) {
    const uint64_t value = slot.submitted;
    if (value == 0) return;
    vulkan::guarded(text("waiting for frame ", value), [&] {
        const vk::Semaphore semaphore = *state.timeline;
        const auto result = context.device().waitSemaphores({{}, semaphore, value}, UINT64_MAX);
        if (result != vk::Result::eSuccess)
            throw Error("waiting for frame ", value, " ended with ", vk::to_string(result));
        collect_times(state, context, slot);
    });
    for (PendingRead& read : slot.reads) read.complete();
    slot.reads.clear();
    slot.resources.clear();
    slot.transients.reset();
    slot.submitted = 0;
}

/// Moves the frame's shape to the front of the list, compiled.
CachedShape& find_shape(Runner::State& state, const FrameGraph& frame, const Description& description) {
    const size_t hash = hash_of(description);
    for (auto shape = state.shapes.begin(); shape != state.shapes.end(); ++shape) {
        if (shape->hash == hash && shape->compiled->description == description && shape->sizes.fit(frame)) {
            state.shapes.splice(state.shapes.begin(), state.shapes, shape);
            return state.shapes.front();
        }
    }
    ++state.compilations;
    auto compiled = std::make_shared<CompiledFrame>(CompiledFrame{description, compile(description)});
    TransientSizes sizes(frame, compiled->plan);
    state.shapes.push_front({hash, std::move(compiled), std::move(sizes), nullptr});
    if (state.shapes.size() > kCachedShapes) state.shapes.pop_back();
    return state.shapes.front();
}

/// Gives the shape its transient resources. Where the memory that the shapes share is too small, it is replaced, and
/// the others get theirs again when they are used next; frames in flight keep what they use.
void place_transients(Runner::State& state, vulkan::Device& device, CachedShape& shape) {
    if (shape.transients) return;
    const Plan& plan = shape.compiled->plan;
    if (!state.memory.holds(plan)) {
        for (CachedShape& other : state.shapes) other.transients.reset();
        state.memory.make_room(device, plan);
    }
    shape.transients = std::make_shared<const Transients>(device, *shape.compiled, shape.sizes, state.memory);
}

}  // namespace

FrameGraph Runner::begin() {
    Slot& slot = *state_->slots[state_->submitted % kFramesInFlight];
    retire(*state_, device_.context(), slot);
    slot.drop_recording();
    slot.upload.reset();
    slot.download.reset();
    state_->descriptors.trim();
    state_->current = &slot;
    return FrameGraph(device_, *this);
}

Staging Runner::stage(uint64_t bytes) {
    PATINA_ASSERT(state_->current != nullptr, "staging outside a frame");
    return state_->current->upload.take(bytes);
}

void Runner::submit(FrameGraph frame) {
    const auto start = std::chrono::steady_clock::now();
    PATINA_ASSERT(state_->current != nullptr, "submit without begin");
    Slot& slot = *state_->current;
    state_->current = nullptr;
    vulkan::Context& context = device_.context();
    CachedShape& shape = find_shape(*state_, frame, frame.description());
    place_transients(*state_, device_, shape);
    state_->last = shape.compiled;
    vulkan::guarded(text("recording frame ", state_->submitted + 1), [&] {
        slot.hold_times_of(context, static_cast<uint32_t>(shape.compiled->plan.order.size()));
        slot.pool.reset();
        slot.commands.begin({vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
        RecordInto into{slot.commands, *slot.queries ? &slot.queries : nullptr, slot.timed_passes, slot.reads,
                        [&](uint64_t bytes) { return slot.download.take(bytes); }};
        record(context, frame, *shape.compiled, *shape.transients, state_->descriptors, into);
        slot.commands.end();
    });
    const uint64_t value = state_->submitted + 1;
    vulkan::guarded(text("submitting frame ", value), [&] {
        const vk::CommandBufferSubmitInfo commands(*slot.commands);
        const vk::SemaphoreSubmitInfo signal(*state_->timeline, value, vk::PipelineStageFlagBits2::eAllCommands);
        context.queue().submit2(vk::SubmitInfo2({}, {}, commands, signal));
    });
    // Only now: nobody may wait for a frame that the device never got.
    slot.resources = std::move(frame.physical_);
    slot.time = frame.time_;
    slot.transients = shape.transients;
    slot.submitted = state_->submitted = value;
    state_->host.samples_ms.push_back(static_cast<float>(milliseconds_since(start)));
}

void Runner::wait() {
    // Oldest first, so that timings keep the order of submission.
    for (uint32_t i = 0; i < kFramesInFlight; ++i) {
        retire(*state_, device_.context(), *state_->slots[(state_->submitted + i) % kFramesInFlight]);
    }
}

const std::vector<Timing>& Runner::pass_timings() const { return state_->timings; }
const Timing& Runner::host_timing() const { return state_->host; }

void Runner::clear_timings() {
    state_->timings.clear();
    state_->timing_index.clear();
    state_->host.samples_ms.clear();
}

void Runner::forget_shapes() {
    state_->shapes.clear();
    state_->memory = {};
}

uint32_t Runner::compilations() const { return state_->compilations; }

uint64_t Runner::transient_bytes() const { return state_->memory.bytes(); }

const CompiledFrame& Runner::last_frame() const { return *state_->last; }

}  // namespace patina::graph
