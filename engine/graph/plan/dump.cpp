#include <array>
#include <cstdio>
#include <utility>

#include "engine/core/error.h"
#include "engine/graph/plan/plan.h"

namespace patina::graph {
namespace {

const char* name_of(Use use) {
    switch (use) {
        case Use::kStorageRead: return "storage_read";
        case Use::kStorageWrite: return "storage_write";
        case Use::kStorageReadWrite: return "storage_read_write";
        case Use::kSampled: return "sampled";
        case Use::kUniform: return "uniform";
        case Use::kIndirect: return "indirect";
        case Use::kTransferRead: return "transfer_read";
        case Use::kTransferModify: return "transfer_modify";
        case Use::kTransferWrite: return "transfer_write";
    }
    PATINA_ASSERT(false, "unknown use ", static_cast<int>(use));
    return "";
}

constexpr std::array kStageNames = {
    std::pair{kStageCompute, "compute"},
    std::pair{kStageTransfer, "transfer"},
    std::pair{kStageIndirect, "indirect"},
};

constexpr std::array kAccessNames = {
    std::pair{kAccessStorageRead, "storage_read"},     std::pair{kAccessStorageWrite, "storage_write"},
    std::pair{kAccessSampledRead, "sampled_read"},     std::pair{kAccessUniformRead, "uniform_read"},
    std::pair{kAccessIndirectRead, "indirect_read"},   std::pair{kAccessTransferRead, "transfer_read"},
    std::pair{kAccessTransferWrite, "transfer_write"},
};

template <class Names>
std::vector<std::string> bit_names(uint32_t bits, const Names& names) {
    std::vector<std::string> found;
    for (const auto& [bit, name] : names) {
        if (bits & bit) found.push_back(name);
    }
    return found;
}

template <class Range, class Format>
std::string joined(const Range& items, const char* separator, const Format& format) {
    std::string out;
    for (const auto& item : items) {
        if (!out.empty()) out += separator;
        out += format(item);
    }
    return out;
}

// ---- JSON ----

std::string json_string(const std::string& value) {
    std::string out = "\"";
    for (char c : value) {
        if (c == '"' || c == '\\') {
            out += {'\\', c};
        } else if (static_cast<unsigned char>(c) < 0x20) {
            std::array<char, 8> escape{};
            std::snprintf(escape.data(), escape.size(), "\\u%04x", static_cast<unsigned>(c));
            out += escape.data();
        } else {
            out += c;
        }
    }
    return out + '"';
}

const char* json_bool(bool value) { return value ? "true" : "false"; }

/// One element a line.
template <class Range, class Format>
std::string json_lines(const Range& items, const Format& format) {
    if (items.empty()) return "[]";
    return text("[\n    ", joined(items, ",\n    ", format), "\n  ]");
}

template <class Range, class Format>
std::string json_list(const Range& items, const Format& format) {
    return text('[', joined(items, ", ", format), ']');
}

std::string json_indices(const std::vector<uint32_t>& indices) {
    return json_list(indices, [](uint32_t index) { return std::to_string(index); });
}

std::string json_need(const MemoryNeed& need) {
    return text(R"({"bytes": )", need.bytes, R"(, "alignment": )", need.alignment, '}');
}

std::string json_resource(const Resource& resource) {
    const char* kind = resource.kind == ResourceKind::kImage ? "image" : "buffer";
    return text(R"({"name": )", json_string(resource.name), R"(, "kind": ")", kind, R"(", "imported": )",
                json_bool(resource.imported), R"(, "need": )", resource.imported ? "null" : json_need(resource.need),
                '}');
}

std::string json_access(const Access& access) {
    return text(R"({"resource": )", access.resource, R"(, "version": )", access.version, R"(, "use": ")",
                name_of(access.use), "\"}");
}

std::string json_pass(const Pass& pass) {
    return text(R"({"name": )", json_string(pass.name), R"(, "accesses": )", json_list(pass.accesses, json_access),
                '}');
}

std::string json_keep(const Keep& keep) {
    return text(R"({"resource": )", keep.resource, R"(, "version": )", keep.version, '}');
}

std::string json_lifetime(const std::optional<Lifetime>& lifetime) {
    if (!lifetime) return "null";
    return text(R"({"first": )", lifetime->first, R"(, "last": )", lifetime->last, '}');
}

std::string json_placement(const std::optional<Placement>& placement) {
    if (!placement) return "null";
    return text(R"({"offset": )", placement->offset, R"(, "bytes": )", placement->bytes, '}');
}

std::string json_scope(const Scope& scope) {
    return text(R"({"stages": )", json_list(bit_names(scope.stages, kStageNames), json_string), R"(, "accesses": )",
                json_list(bit_names(scope.accesses, kAccessNames), json_string), '}');
}

std::string json_barrier(const Barrier& barrier) {
    return text(R"({"before": )", barrier.before, R"(, "resource": )",
                barrier.resource ? std::to_string(*barrier.resource) : "null", R"(, "source": )",
                json_scope(barrier.source), R"(, "destination": )", json_scope(barrier.destination), R"(, "discard": )",
                json_bool(barrier.discard), '}');
}

// ---- DOT ----

std::string dot_string(const std::string& value) {
    std::string out = "\"";
    for (char c : value) {
        if (c == '"' || c == '\\') out += '\\';
        if (c == '\n') {
            out += "\\n";
        } else {
            out += c;
        }
    }
    return out + '"';
}

std::string version_node(uint32_t resource, uint32_t version) { return text('r', resource, 'v', version); }

std::string scope_label(const Scope& scope) {
    const auto unchanged = [](const std::string& name) { return name; };
    const std::string stages = joined(bit_names(scope.stages, kStageNames), "|", unchanged);
    const std::string accesses = joined(bit_names(scope.accesses, kAccessNames), "|", unchanged);
    return accesses.empty() ? stages : text(stages, '(', accesses, ')');
}

std::string barrier_label(const Barrier& barrier) {
    return text(scope_label(barrier.source), " -> ", scope_label(barrier.destination),
                barrier.discard ? ", discard" : "");
}

/// Writes the digraph of one frame.
class DotWriter {
  public:
    DotWriter(const Description& description, const Plan& plan) : description_(description), plan_(plan) {}

    std::string write() {
        out_ = "digraph frame {\n  rankdir=LR;\n  node [fontsize=10];\n  edge [fontsize=8];\n";
        for (uint32_t position = 0; position < plan_.order.size(); ++position)
            add_pass(plan_.order[position], position);
        for (uint32_t index : plan_.culled) add_pass(index, std::nullopt);
        for (const Barrier& barrier : plan_.barriers) {
            if (barrier.resource) continue;
            out_ +=
                text("  boundary [shape=plaintext, label=\"earlier frames\"];\n  boundary -> p",
                     plan_.order[barrier.before], " [color=red, label=", dot_string(barrier_label(barrier)), "];\n");
        }
        return out_ + "}\n";
    }

  private:
    void add_pass(uint32_t index, std::optional<uint32_t> position) {
        const Pass& pass = description_.passes[index];
        const char* style = position ? "solid" : "dashed";
        const std::string label = position ? text(*position, ' ', pass.name) : pass.name;
        out_ += text("  p", index, " [shape=box, style=", style, ", label=", dot_string(label), "];\n");
        for (const Access& access : pass.accesses) add_access(index, access, position);
    }

    /// The edge into the pass carries the barrier if the pass reads, else the edge out of it does.
    void add_access(uint32_t index, const Access& access, std::optional<uint32_t> position) {
        const std::string pass = text('p', index);
        const char* style = position ? "solid" : "dashed";
        const Barrier* barrier = position ? find_barrier(*position, access.resource) : nullptr;
        if (reads(access.use)) {
            add_version(access.resource, access.version);
            add_edge(version_node(access.resource, access.version), pass, style, access.use, barrier);
            barrier = nullptr;
        }
        if (writes(access.use)) {
            add_version(access.resource, access.version + 1);
            add_edge(pass, version_node(access.resource, access.version + 1), style, access.use, barrier);
        }
    }

    void add_version(uint32_t resource, uint32_t version) {
        const std::string label = text(description_.resources[resource].name, " v", version);
        out_ += text("  ", version_node(resource, version), " [shape=ellipse, label=", dot_string(label), "];\n");
    }

    void add_edge(const std::string& from, const std::string& to, const char* style, Use use, const Barrier* barrier) {
        const std::string label = barrier ? text(name_of(use), '\n', barrier_label(*barrier)) : name_of(use);
        out_ += text("  ", from, " -> ", to, " [style=", style, barrier ? ", color=red" : "",
                     ", label=", dot_string(label), "];\n");
    }

    const Barrier* find_barrier(uint32_t position, uint32_t resource) const {
        for (const Barrier& barrier : plan_.barriers) {
            if (barrier.before == position && barrier.resource == resource) return &barrier;
        }
        return nullptr;
    }

    const Description& description_;
    const Plan& plan_;
    std::string out_;
};

}  // namespace

std::string to_dot(const Description& description, const Plan& plan) { return DotWriter(description, plan).write(); }

std::string to_json(const Description& description, const Plan& plan) {
    return text("{\n  \"resources\": ", json_lines(description.resources, json_resource),
                ",\n  \"passes\": ", json_lines(description.passes, json_pass),
                ",\n  \"kept\": ", json_list(description.kept, json_keep), ",\n  \"order\": ", json_indices(plan.order),
                ",\n  \"culled\": ", json_indices(plan.culled),
                ",\n  \"lifetimes\": ", json_list(plan.lifetimes, json_lifetime),
                ",\n  \"placements\": ", json_list(plan.placements, json_placement),
                ",\n  \"barriers\": ", json_lines(plan.barriers, json_barrier),
                ",\n  \"buffer_arena\": ", json_need(plan.buffer_arena),
                ",\n  \"image_arena\": ", json_need(plan.image_arena), "\n}\n");
}

}  // namespace patina::graph
