// Build tool: turns one SPIR-V module into a C++ constant with what SPIRV-Cross reflects from it (bindings, push
// constant size, group size, specialization constants), and into static assertions that compare every struct it uses,
// field by field, with the C++ side of shaders/shared. Usage: patina_pack_shader MODULE.spv OUT.cpp NAME IDENTIFIER
// HEADER...

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <initializer_list>
#include <iostream>
#include <iterator>
#include <memory>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <spirv_cross/spirv_cross_c.h>

#include "engine/vulkan/floor.h"

namespace {

struct Module {
    struct Destroy {
        void operator()(spvc_context_s* destroyed) const { spvc_context_destroy(destroyed); }
    };
    std::unique_ptr<spvc_context_s, Destroy> context;  ///< owns the others
    spvc_compiler compiler = nullptr;
    spvc_resources resources = nullptr;
};

void check(const Module& module, spvc_result result) {
    if (result != SPVC_SUCCESS) throw std::runtime_error(spvc_context_get_last_error_string(module.context.get()));
}

Module parse(const std::vector<SpvId>& words) {
    Module module;
    spvc_context context = nullptr;
    const spvc_result created = spvc_context_create(&context);
    module.context.reset(context);
    check(module, created);
    spvc_parsed_ir ir = nullptr;
    check(module, spvc_context_parse_spirv(context, words.data(), words.size(), &ir));
    check(module, spvc_context_create_compiler(context, SPVC_BACKEND_NONE, ir, SPVC_CAPTURE_MODE_TAKE_OWNERSHIP,
                                               &module.compiler));
    check(module, spvc_compiler_create_shader_resources(module.compiler, &module.resources));
    return module;
}

/// The C++ type of a scalar, vector or matrix.
std::string cpp_type(spvc_type type) {
    const unsigned rows = spvc_type_get_vector_size(type);
    const unsigned columns = spvc_type_get_columns(type);
    std::string scalar, prefix;
    switch (spvc_type_get_basetype(type)) {
        case SPVC_BASETYPE_FP32: scalar = "float"; break;
        case SPVC_BASETYPE_UINT32: scalar = "uint", prefix = "u"; break;
        case SPVC_BASETYPE_INT32: scalar = "int", prefix = "i"; break;
        default: throw std::runtime_error("a shared struct has a member that is not made of 32-bit numbers");
    }
    if (columns > 1) return "patina::gpu::mat" + std::to_string(columns);
    if (rows > 1) return "patina::gpu::" + prefix + "vec" + std::to_string(rows);
    return scalar == "uint" ? "patina::gpu::uint" : scalar;
}

/// Emits assertions for every struct reachable from a block's members.
class LayoutAssertions {
  public:
    explicit LayoutAssertions(const Module& module) : module_(module) {}

    /// `block` is the interface block itself: its members may be numbers or arrays of numbers, or structs of
    /// shaders/shared.
    void add_block(spvc_type_id block, bool must_be_struct) {
        const spvc_type type = spvc_compiler_get_type_handle(module_.compiler, block);
        const spvc_type_id base = spvc_type_get_base_type_id(type);
        for (unsigned i = 0; i < spvc_type_get_num_member_types(type); ++i) {
            const spvc_type member = member_type(type, i);
            if (spvc_type_get_basetype(member) != SPVC_BASETYPE_STRUCT) {
                if (must_be_struct) {
                    throw std::runtime_error(std::string("the block '") +
                                             spvc_compiler_get_name(module_.compiler, base) +
                                             "' must hold one struct of shaders/shared");
                }
                continue;
            }
            if (spvc_type_get_num_array_dimensions(member) > 0) {
                unsigned stride = 0;
                spvc_compiler_type_struct_member_array_stride(module_.compiler, type, i, &stride);
                assertions_ << "static_assert(sizeof(" << struct_name(member) << ") == " << stride << ");\n";
            }
            add_struct(member);
        }
    }

    std::string text() const { return assertions_.str(); }

  private:
    spvc_type member_type(spvc_type type, unsigned index) const {
        return spvc_compiler_get_type_handle(module_.compiler, spvc_type_get_member_type(type, index));
    }

    std::string struct_name(spvc_type type) const {
        return std::string("patina::gpu::") +
               spvc_compiler_get_name(module_.compiler, spvc_type_get_base_type_id(type));
    }

    void add_struct(spvc_type type) {
        const std::string name = struct_name(type);
        if (!done_.insert(name).second) return;
        const spvc_type_id base = spvc_type_get_base_type_id(type);
        size_t bytes = 0;
        check(module_, spvc_compiler_get_declared_struct_size(
                           module_.compiler, spvc_compiler_get_type_handle(module_.compiler, base), &bytes));
        assertions_ << "static_assert(sizeof(" << name << ") == " << bytes << ");\n";
        for (unsigned i = 0; i < spvc_type_get_num_member_types(type); ++i) add_member(type, base, name, i);
    }

    void add_member(spvc_type type, spvc_type_id base, const std::string& name, unsigned index) {
        const spvc_type member = member_type(type, index);
        const std::string field = spvc_compiler_get_member_name(module_.compiler, base, index);
        unsigned offset = 0;
        check(module_, spvc_compiler_type_struct_member_offset(module_.compiler, type, index, &offset));
        assertions_ << "static_assert(offsetof(" << name << ", " << field << ") == " << offset << ");\n";
        std::string expected;
        if (spvc_type_get_basetype(member) == SPVC_BASETYPE_STRUCT) {
            expected = struct_name(member);
            add_struct(member);
        } else {
            expected = cpp_type(member);
        }
        for (unsigned d = 0; d < spvc_type_get_num_array_dimensions(member); ++d) {
            expected += "[" + std::to_string(spvc_type_get_array_dimension(member, d)) + "]";
        }
        assertions_ << "static_assert(std::is_same_v<decltype(" << name << "::" << field << "), " << expected
                    << ">);\n";
    }

    const Module& module_;
    std::set<std::string> done_;
    std::ostringstream assertions_;
};

struct Binding {
    std::string name, kind, format = "kR32f";
    unsigned number = 0, count = 1;
    bool reads = true, writes = true;

    bool operator<(const Binding& other) const { return number < other.number; }
};

const char* format_name(SpvImageFormat format) {
    switch (format) {
        case SpvImageFormatR32f: return "kR32f";
        case SpvImageFormatRgba32f: return "kRgba32f";
        case SpvImageFormatRgba16f: return "kRgba16f";
        case SpvImageFormatRgba8: return "kRgba8";
        case SpvImageFormatR32ui: return "kR32u";
        case SpvImageFormatRgba32ui: return "kRgba32u";
        default: throw std::runtime_error("a storage image has a format that engine/vulkan/format.h does not list");
    }
}

bool has_decoration(const std::vector<SpvDecoration>& decorations, SpvDecoration wanted) {
    return std::find(decorations.begin(), decorations.end(), wanted) != decorations.end();
}

void read_buffer_access(const Module& module, const spvc_reflected_resource& resource, Binding& binding) {
    const SpvDecoration* list = nullptr;
    size_t count = 0;
    check(module, spvc_compiler_get_buffer_block_decorations(module.compiler, resource.id, &list, &count));
    const std::vector<SpvDecoration> decorations(list, list + count);
    binding.reads = !has_decoration(decorations, SpvDecorationNonReadable);
    binding.writes = !has_decoration(decorations, SpvDecorationNonWritable);
}

Binding reflect(const Module& module, spvc_resource_type kind, const spvc_reflected_resource& resource) {
    spvc_compiler compiler = module.compiler;
    const spvc_type type = spvc_compiler_get_type_handle(compiler, resource.type_id);
    Binding binding;
    binding.number = spvc_compiler_get_decoration(compiler, resource.id, SpvDecorationBinding);
    if (spvc_compiler_get_decoration(compiler, resource.id, SpvDecorationDescriptorSet) != 0) {
        throw std::runtime_error("bindings must be in descriptor set 0");
    }
    if (spvc_type_get_num_array_dimensions(type) > 0) binding.count = spvc_type_get_array_dimension(type, 0);
    binding.name = spvc_compiler_get_name(
        compiler, kind == SPVC_RESOURCE_TYPE_STORAGE_BUFFER || kind == SPVC_RESOURCE_TYPE_UNIFORM_BUFFER
                      ? resource.base_type_id
                      : resource.id);
    switch (kind) {
        case SPVC_RESOURCE_TYPE_STORAGE_BUFFER:
            binding.kind = "kStorageBuffer";
            read_buffer_access(module, resource, binding);
            break;
        case SPVC_RESOURCE_TYPE_UNIFORM_BUFFER:
            binding.kind = "kUniformBuffer";
            binding.writes = false;
            break;
        case SPVC_RESOURCE_TYPE_STORAGE_IMAGE:
            binding.kind = spvc_type_get_image_dimension(type) == SpvDimBuffer ? "kTexelBuffer" : "kStorageImage";
            binding.reads = !spvc_compiler_has_decoration(compiler, resource.id, SpvDecorationNonReadable);
            binding.writes = !spvc_compiler_has_decoration(compiler, resource.id, SpvDecorationNonWritable);
            binding.format = format_name(spvc_type_get_image_storage_format(type));
            break;
        default: binding.writes = false; binding.kind = "kSampledImage";
    }
    return binding;
}

std::vector<Binding> reflect_bindings(const Module& module, LayoutAssertions& layouts) {
    std::vector<Binding> bindings;
    for (const spvc_resource_type kind : {SPVC_RESOURCE_TYPE_STORAGE_BUFFER, SPVC_RESOURCE_TYPE_UNIFORM_BUFFER,
                                          SPVC_RESOURCE_TYPE_STORAGE_IMAGE, SPVC_RESOURCE_TYPE_SAMPLED_IMAGE}) {
        const spvc_reflected_resource* list = nullptr;
        size_t count = 0;
        check(module, spvc_resources_get_resource_list_for_type(module.resources, kind, &list, &count));
        for (size_t i = 0; i < count; ++i) {
            bindings.push_back(reflect(module, kind, list[i]));
            if (kind == SPVC_RESOURCE_TYPE_STORAGE_BUFFER) layouts.add_block(list[i].base_type_id, false);
            if (kind == SPVC_RESOURCE_TYPE_UNIFORM_BUFFER) layouts.add_block(list[i].base_type_id, true);
        }
    }
    std::sort(bindings.begin(), bindings.end());
    return bindings;
}

/// Bytes and alignment of a type under the std430 rules, booleans as 32-bit integers.
struct Layout {
    size_t bytes = 0, alignment = 4;

    void append(const Layout& member) {
        bytes = aligned(bytes, member.alignment) + member.bytes;
        alignment = std::max(alignment, member.alignment);
    }
    static size_t aligned(size_t bytes, size_t alignment) { return (bytes + alignment - 1) / alignment * alignment; }
};

size_t array_length(const Module& module, spvc_type type, unsigned dimension) {
    const SpvId length = spvc_type_get_array_dimension(type, dimension);
    if (spvc_type_array_dimension_is_literal(type, dimension)) return length;
    // A specialization constant counts by its default.
    const spvc_constant constant = spvc_compiler_get_constant_handle(module.compiler, length);
    if (!constant) throw std::runtime_error("a shared array's length is computed from specialization constants");
    return spvc_constant_get_scalar_u32(constant, 0, 0);
}

Layout std430_layout(const Module& module, spvc_type type) {
    Layout element;
    if (spvc_type_get_basetype(type) == SPVC_BASETYPE_STRUCT) {
        for (unsigned i = 0; i < spvc_type_get_num_member_types(type); ++i) {
            element.append(std430_layout(
                module, spvc_compiler_get_type_handle(module.compiler, spvc_type_get_member_type(type, i))));
        }
        element.bytes = Layout::aligned(element.bytes, element.alignment);
    } else {
        const unsigned rows = spvc_type_get_vector_size(type), columns = spvc_type_get_columns(type);
        element.alignment = 4u * (rows == 3 ? 4 : rows);
        element.bytes = columns > 1 ? columns * element.alignment : 4u * rows;
    }
    for (unsigned d = 0; d < spvc_type_get_num_array_dimensions(type); ++d)
        element.bytes = Layout::aligned(element.bytes, element.alignment) * array_length(module, type, d);
    return element;
}

/// The most shared memory that a driver may take for the module's variables (Vulkan's rule for
/// maxComputeSharedMemorySize), in the order of their declaration. Reflection does not list them, the words do.
size_t shared_bytes(const Module& module, const std::vector<SpvId>& words) {
    constexpr size_t kHeaderWords = 5;
    Layout all;
    for (size_t at = kHeaderWords; at < words.size();) {
        const SpvId operation = words[at] & SpvOpCodeMask, length = words[at] >> SpvWordCountShift;
        if (length == 0 || at + length > words.size()) throw std::runtime_error("the SPIR-V module is cut short");
        if (operation == SpvOpVariable && words[at + 3] == SpvStorageClassWorkgroup)
            all.append(std430_layout(module, spvc_compiler_get_type_handle(module.compiler, words[at + 1])));
        at += length;
    }
    return all.bytes;
}

/// Throws where the shader `name` needs more than a device of the portability floor must have.
void check_floor(const std::string& name, const std::vector<Binding>& bindings, size_t push_bytes, size_t shared,
                 unsigned invocations) {
    namespace floor = patina::vulkan::floor;
    const auto bound = [&](std::initializer_list<const char*> kinds) {
        unsigned total = 0;
        for (const Binding& b : bindings) {
            if (std::find(kinds.begin(), kinds.end(), b.kind) != kinds.end()) total += b.count;
        }
        return total;
    };
    const auto check_most = [&](size_t has, size_t most, const std::string& what) {
        if (has <= most) return;
        throw std::runtime_error("the shader " + name + " needs " + std::to_string(has) + ' ' + what +
                                 ", but at most " + std::to_string(most) + " are portable");
    };
    const auto check_bound = [&](std::initializer_list<const char*> kinds, size_t most, const std::string& what) {
        check_most(bound(kinds), most, what + ", every element of an array counted");
    };
    const bool texel_variant = name.ends_with("_texel");
    check_bound({"kStorageBuffer"}, floor::kStorageBuffers, "storage buffers");
    check_bound({"kStorageImage", "kTexelBuffer"}, texel_variant ? floor::kTexelVariantImages : floor::kStorageImages,
                "storage images");
    check_bound({"kSampledImage"}, floor::kSampledImages, "sampled images");
    check_bound({"kUniformBuffer"}, floor::kUniformBuffers, "uniform buffers");
    check_most(push_bytes, floor::kPushBytes, "bytes of push constants");
    check_most(shared, floor::kSharedBytes, "bytes of shared memory");
    check_most(invocations, floor::kGroupInvocations, "invocations in a group");
}

size_t reflect_push(const Module& module, LayoutAssertions& layouts) {
    const spvc_reflected_resource* list = nullptr;
    size_t count = 0;
    check(module,
          spvc_resources_get_resource_list_for_type(module.resources, SPVC_RESOURCE_TYPE_PUSH_CONSTANT, &list, &count));
    if (count == 0) return 0;
    layouts.add_block(list[0].base_type_id, true);
    size_t bytes = 0;
    check(module, spvc_compiler_get_declared_struct_size(
                      module.compiler, spvc_compiler_get_type_handle(module.compiler, list[0].base_type_id), &bytes));
    return bytes;
}

void write_words(const std::vector<SpvId>& words, std::ostream& out) {
    out << "constexpr uint32_t kWords[] = {";
    for (size_t i = 0; i < words.size(); ++i) out << (i % 16 == 0 ? "\n" : "") << words[i] << "u,";
    out << "};\n";
}

void write_constants(const Module& module, std::ostream& out) {
    const spvc_specialization_constant* list = nullptr;
    size_t count = 0;
    check(module, spvc_compiler_get_specialization_constants(module.compiler, &list, &count));
    std::vector<spvc_specialization_constant> constants(list, list + count);
    std::sort(constants.begin(), constants.end(), [](auto& a, auto& b) { return a.constant_id < b.constant_id; });
    out << "const std::vector<patina::vulkan::ShaderConstant> kConstants = {\n";
    for (const auto& constant : constants) {
        const spvc_constant value = spvc_compiler_get_constant_handle(module.compiler, constant.id);
        out << "{\"" << spvc_compiler_get_name(module.compiler, constant.id) << "\", " << constant.constant_id << "u, "
            << spvc_constant_get_scalar_u32(value, 0, 0) << "u},\n";
    }
    out << "};\n";
}

void write_bindings(const std::vector<Binding>& bindings, std::ostream& out) {
    out << std::boolalpha << "const std::vector<patina::vulkan::ShaderBinding> kBindings = {\n";
    for (const Binding& b : bindings) {
        out << "{\"" << b.name << "\", " << b.number << ", patina::vulkan::BindingKind::" << b.kind << ", " << b.count
            << ", " << b.reads << ", " << b.writes << ", patina::vulkan::Format::" << b.format << "},\n";
    }
    out << "};\n";
}

std::vector<SpvId> read_words(const char* path) {
    std::ifstream in(path, std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(in)), {});
    if (bytes.empty() || bytes.size() % 4 != 0) throw std::runtime_error(std::string(path) + " is no SPIR-V module");
    std::vector<SpvId> words(bytes.size() / 4);
    std::copy(bytes.begin(), bytes.end(), reinterpret_cast<char*>(words.data()));
    return words;
}

void pack(const char* path, const char* name, const char* identifier, const std::vector<std::string>& headers,
          std::ostream& out) {
    const std::vector<SpvId> words = read_words(path);
    const Module module = parse(words);
    LayoutAssertions layouts(module);
    const std::vector<Binding> bindings = reflect_bindings(module, layouts);
    const size_t push_bytes = reflect_push(module, layouts);
    std::array<unsigned, 3> group{};
    for (unsigned axis = 0; axis < 3; ++axis) {
        group[axis] =
            spvc_compiler_get_execution_mode_argument_by_index(module.compiler, SpvExecutionModeLocalSize, axis);
    }
    check_floor(name, bindings, push_bytes, shared_bytes(module, words), group[0] * group[1] * group[2]);

    out << "// Generated from the SPIR-V of " << name
        << ".\n#include <cstddef>\n#include <type_traits>\n#include <vector>\n"
        << "#include \"engine/vulkan/shader.h\"\n#include \"spirv/shaders.h\"\n";
    for (const std::string& header : headers) out << "#include \"" << header << "\"\n";
    const std::string parts =
        std::string("patina::spirv::parts_of_") + identifier;  // several may share one translation unit
    out << layouts.text() << "\nnamespace " << parts << " {\n";
    write_words(words, out);
    write_bindings(bindings, out);
    write_constants(module, out);
    out << "}\nconst patina::vulkan::Shader patina::spirv::" << identifier << " = {\"" << name << "\", " << parts
        << "::kWords, " << parts << "::kBindings, " << parts << "::kConstants, " << push_bytes << "u, {";
    for (const unsigned invocations : group) out << invocations << "u,";
    out << "}};\n";
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 5) {
        std::fprintf(stderr, "usage: %s MODULE.spv OUT.cpp NAME IDENTIFIER HEADER...\n", argv[0]);
        return 2;
    }
    try {
        std::ostringstream out;
        pack(argv[1], argv[3], argv[4], {argv + 5, argv + argc}, out);
        std::ofstream(argv[2]) << out.str();
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s: %s\n", argv[1], error.what());
        return 1;
    }
}
