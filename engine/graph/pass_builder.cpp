#include <algorithm>
#include <cstring>

#include "engine/graph/frame_graph.h"

namespace patina::graph {

using vulkan::BindingKind;
using vulkan::ShaderBinding;

template <class... Parts>
void PassBuilder::fail(const Parts&... parts) const {
    throw Error("the pass '", pass_.name, "' ", parts...);
}

PassBuilder::PassBuilder(FrameGraph& frame, std::string name, const vulkan::Shader& shader) : frame_(frame) {
    pass_.name = std::move(name);
    dispatch_.shader = &shader;
    dispatch_.bound.reserve(shader.bindings.size());
}

Use PassBuilder::use_of(const ShaderBinding& binding, Intent intent) const {
    switch (binding.kind) {
        case BindingKind::kUniformBuffer: return Use::kUniform;
        case BindingKind::kSampledImage: return Use::kSampled;
        case BindingKind::kTexelBuffer:
        case BindingKind::kStorageBuffer:
        case BindingKind::kStorageImage: break;
    }
    switch (intent) {
        case Intent::kRead: return Use::kStorageRead;
        case Intent::kWrite: return Use::kStorageWrite;
        case Intent::kModify: return Use::kStorageReadWrite;
    }
    return Use::kStorageRead;
}

void PassBuilder::check_shape(const ShaderBinding& binding, uint32_t resource) const {
    const FrameGraph::Physical& physical = frame_.physical_[resource];
    const std::string& name = frame_.description_.resources[resource].name;
    if (binding.kind == BindingKind::kStorageImage && binding.format != physical.shape.format) {
        fail("binds the ", name_of(physical.shape.format), " image '", name, "' to '", binding.name, "', which is ",
             name_of(binding.format));
    }
    if (physical.buffers.size() > binding.count) {
        fail("binds '", name, "' of ", physical.buffers.size(), " chunks to '", binding.name, "', which takes ",
             binding.count);
    }
}

uint32_t PassBuilder::bind(const char* binding_name, ResourceId id, ResourceKind kind, Intent intent) {
    const ShaderBinding* binding = dispatch_.shader->find_binding(binding_name);
    if (!binding) fail("binds '", binding_name, "', which the shader ", dispatch_.shader->name, " does not declare");
    if (!id.valid()) fail("binds an empty id to '", binding_name, "'");
    const std::string& name = frame_.description_.resources[id.resource].name;
    const bool is_image = binding->kind == BindingKind::kStorageImage || binding->kind == BindingKind::kSampledImage;
    if (is_image != (kind == ResourceKind::kImage)) {
        fail("binds the ", kind == ResourceKind::kImage ? "image" : "buffer", " '", name, "' to '", binding_name,
             "', which is ", is_image ? "an image" : "a buffer");
    }
    if (std::any_of(dispatch_.bound.begin(), dispatch_.bound.end(),
                    [&](const auto& b) { return b.binding == binding; })) {
        fail("binds '", binding_name, "' twice");
    }
    if (intent == Intent::kRead && binding->writes) fail("reads '", binding_name, "', which the shader may write");
    if (intent != Intent::kRead && !binding->writes) fail("writes '", binding_name, "', which the shader only reads");
    if (intent == Intent::kWrite && binding->reads && !is_image) {
        fail("replaces '", binding_name, "', which the shader also reads: declare it writeonly or modify it");
    }
    check_shape(*binding, id.resource);
    dispatch_.bound.push_back({binding, id.resource});
    pass_.accesses.push_back({id.resource, id.version, use_of(*binding, intent)});
    if (intent == Intent::kRead) return id.version;
    if (id.version != frame_.current_version(id.resource)) {
        fail("writes version ", id.version, " of '", name, "', whose current version is ",
             frame_.current_version(id.resource));
    }
    return ++frame_.versions_[id.resource];
}

PassBuilder& PassBuilder::read(const char* binding, BufferId id) {
    bind(binding, id, ResourceKind::kBuffer, Intent::kRead);
    return *this;
}

PassBuilder& PassBuilder::read(const char* binding, ImageId id) {
    bind(binding, id, ResourceKind::kImage, Intent::kRead);
    return *this;
}

BufferId PassBuilder::write(const char* binding, BufferId id) {
    return {{id.resource, bind(binding, id, ResourceKind::kBuffer, Intent::kWrite)}};
}

ImageId PassBuilder::write(const char* binding, ImageId id) {
    return {{id.resource, bind(binding, id, ResourceKind::kImage, Intent::kWrite)}};
}

BufferId PassBuilder::modify(const char* binding, BufferId id) {
    return {{id.resource, bind(binding, id, ResourceKind::kBuffer, Intent::kModify)}};
}

ImageId PassBuilder::modify(const char* binding, ImageId id) {
    return {{id.resource, bind(binding, id, ResourceKind::kImage, Intent::kModify)}};
}

ImageId PassBuilder::create(const char* binding, ImageShape shape) {
    return write(binding, frame_.create_image(pass_.name + '.' + binding, shape));
}

BufferId PassBuilder::create(const char* binding, uint64_t bytes) {
    return write(binding, frame_.create_buffer(pass_.name + '.' + binding, bytes));
}

PassBuilder& PassBuilder::specialise(const char* constant, uint32_t value) {
    const vulkan::ShaderConstant* found = dispatch_.shader->find_constant(constant);
    if (!found)
        fail("sets the constant '", constant, "', which the shader ", dispatch_.shader->name, " does not declare");
    dispatch_.constants.emplace_back(found->id, value);
    return *this;
}

void PassBuilder::set_push(const void* data, size_t bytes) {
    if (bytes != dispatch_.shader->push_bytes) {
        fail("pushes ", bytes, " bytes, the shader takes ", dispatch_.shader->push_bytes);
    }
    if (bytes > dispatch_.push.size())
        fail("pushes ", bytes, " bytes, at most ", dispatch_.push.size(), " are portable");
    std::memcpy(dispatch_.push.data(), data, bytes);
    pushed_ = true;
}

void PassBuilder::finish() {
    if (dispatch_.shader->push_bytes > 0 && !pushed_)
        fail("pushes nothing, the shader takes ", dispatch_.shader->push_bytes, " bytes");
    for (const ShaderBinding& binding : dispatch_.shader->bindings) {
        const bool is_bound = std::any_of(dispatch_.bound.begin(), dispatch_.bound.end(),
                                          [&](const work::Bound& b) { return b.binding == &binding; });
        if (!is_bound) fail("leaves '", binding.name, "' unbound");
    }
    std::sort(dispatch_.constants.begin(), dispatch_.constants.end());
    frame_.description_.passes.push_back(std::move(pass_));
    frame_.work_.push_back(std::move(dispatch_));
}

void PassBuilder::dispatch(uint32_t groups_x, uint32_t groups_y, uint32_t groups_z) {
    constexpr uint32_t kMaxGroups = 65535;  // what every device takes per axis
    if (std::max({groups_x, groups_y, groups_z}) > kMaxGroups) {
        fail("dispatches ", groups_x, " x ", groups_y, " x ", groups_z, " groups, at most ", kMaxGroups,
             " per axis are portable");
    }
    dispatch_.groups = {groups_x, groups_y, groups_z};
    finish();
}

void PassBuilder::dispatch_covering(Extent2D extent) {
    const auto& group = dispatch_.shader->group_size;
    dispatch((extent.width + group[0] - 1) / group[0], (extent.height + group[1] - 1) / group[1]);
}

void PassBuilder::dispatch_covering(uint32_t items) {
    const uint32_t group = dispatch_.shader->group_size[0];
    dispatch((items + group - 1) / group);
}

void PassBuilder::dispatch_indirect(BufferId arguments, uint64_t offset) {
    for (const Access& access : pass_.accesses) {
        if (access.resource == arguments.resource) {
            fail("takes its group counts from '", frame_.description_.resources[arguments.resource].name,
                 "', which it also binds");
        }
    }
    pass_.accesses.push_back({arguments.resource, arguments.version, Use::kIndirect});
    dispatch_.indirect = arguments.resource;
    dispatch_.indirect_offset = offset;
    finish();
}

}  // namespace patina::graph
