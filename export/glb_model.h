#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <glm/glm.hpp>
#include <tiny_gltf.h>

namespace patina {

/// Reads a GLB. Pictures stay encoded: Image::image has the bytes of the file that they are. Throws Error, naming the
/// file, where it is missing or no GLB.
tinygltf::Model read_glb(const std::filesystem::path& file);

/// What a model's arrays hold. All functions throw Error, naming the file, where an array is missing, does not lie
/// within the buffer, or has another format than a Patina file's.
class GlbArrays {
  public:
    /// Both must outlive this.
    GlbArrays(const std::filesystem::path& file, const tinygltf::Model& model) : file_(file), model_(model) {}

    /// Float32 vectors.
    std::vector<glm::vec3> vectors(int accessor) const;
    std::vector<glm::vec2> pairs(int accessor) const;
    std::vector<glm::vec4> quads(int accessor) const;
    std::vector<float> scalars(int accessor) const;
    /// COLOR_0, normalised u16: linear. Alpha is left out.
    std::vector<glm::vec3> colors(int accessor) const;
    /// Of a primitive, each below `vertices`.
    std::vector<std::array<uint32_t, 3>> triangles(const tinygltf::Primitive& primitive, size_t vertices) const;

    /// An element of one of the model's lists.
    template <class Element>
    const Element& at(const std::vector<Element>& elements, int index, const char* what) const {
        if (index < 0 || static_cast<size_t>(index) >= elements.size()) fail_missing(what, index, elements.size());
        return elements[static_cast<size_t>(index)];
    }

  private:
    [[noreturn]] void fail_missing(const char* what, int index, size_t count) const;
    template <class Element>
    std::vector<Element> elements(int accessor, int component, int type) const;

    const std::filesystem::path& file_;
    const tinygltf::Model& model_;
};

/// How many of a Patina file's pictures are pages with base colours: these come first.
size_t base_color_pages(const tinygltf::Model& model);

/// The accessor of a primitive's attribute; -1 where there is none.
int attribute_of(const tinygltf::Primitive& primitive, const char* name);

}  // namespace patina
