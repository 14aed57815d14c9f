#include "scenes/render/material_table.h"

#include <array>

namespace patina::scenes {
namespace {

using V = glm::dvec3;

const std::array kMaterials{
    // Matt and satin paints.
    TableMaterial{"white wall paint", V(0.56, 0.55, 0.52), V(0.012), 0.42},
    TableMaterial{"sand wall paint", V(0.46, 0.38, 0.27), V(0.014), 0.45},
    TableMaterial{"sage wall paint", V(0.22, 0.29, 0.20), V(0.013), 0.40},
    TableMaterial{"brick red paint", V(0.25, 0.055, 0.035), V(0.020), 0.35},
    TableMaterial{"slate blue satin paint", V(0.065, 0.11, 0.19), V(0.035), 0.22},
    TableMaterial{"ochre satin paint", V(0.38, 0.20, 0.035), V(0.032), 0.26},
    TableMaterial{"white gloss paint", V(0.52, 0.52, 0.49), V(0.038), 0.060},
    TableMaterial{"black gloss paint", V(0.003, 0.003, 0.003), V(0.045), 0.045},
    TableMaterial{"green metallic paint", V(0.012, 0.045, 0.028), V(0.060, 0.105, 0.070), 0.15},
    // Fabrics and leather: broad lobes.
    TableMaterial{"grey wool", V(0.10, 0.10, 0.11), V(0.018), 0.50},
    TableMaterial{"navy cotton", V(0.012, 0.018, 0.055), V(0.010), 0.48},
    TableMaterial{"natural linen", V(0.36, 0.31, 0.23), V(0.020), 0.50},
    TableMaterial{"crimson velvet", V(0.16, 0.010, 0.016), V(0.030, 0.016, 0.016), 0.50},
    TableMaterial{"mustard felt", V(0.33, 0.19, 0.025), V(0.015), 0.50},
    TableMaterial{"teal silk", V(0.020, 0.12, 0.13), V(0.090, 0.11, 0.11), 0.30},
    TableMaterial{"brown leather", V(0.075, 0.033, 0.015), V(0.040), 0.20},
    TableMaterial{"black leather", V(0.009, 0.008, 0.008), V(0.042), 0.24},
    // Plastics.
    TableMaterial{"white polypropylene", V(0.45, 0.45, 0.43), V(0.035), 0.10},
    TableMaterial{"red acrylic", V(0.31, 0.012, 0.014), V(0.038), 0.020},
    TableMaterial{"yellow acrylic", V(0.48, 0.33, 0.015), V(0.037), 0.024},
    TableMaterial{"blue polystyrene", V(0.020, 0.065, 0.27), V(0.040), 0.065},
    TableMaterial{"green textured plastic", V(0.035, 0.17, 0.045), V(0.045), 0.27},
    TableMaterial{"orange matt plastic", V(0.42, 0.12, 0.012), V(0.030), 0.32},
    TableMaterial{"grey computer plastic", V(0.23, 0.23, 0.22), V(0.034), 0.18},
    TableMaterial{"black phenolic", V(0.003, 0.003, 0.003), V(0.039), 0.028},
    TableMaterial{"violet polyethylene", V(0.085, 0.030, 0.14), V(0.036), 0.12},
    // Woods, oiled and lacquered.
    TableMaterial{"oiled oak", V(0.24, 0.14, 0.070), V(0.033), 0.21},
    TableMaterial{"lacquered maple", V(0.37, 0.25, 0.13), V(0.040), 0.085},
    TableMaterial{"lacquered cherry", V(0.12, 0.040, 0.016), V(0.042), 0.10},
    TableMaterial{"waxed walnut", V(0.036, 0.020, 0.011), V(0.036), 0.16},
    // Rubber, stone, ceramics.
    TableMaterial{"natural rubber", V(0.34, 0.27, 0.17), V(0.043), 0.38},
    TableMaterial{"black rubber", V(0.011, 0.011, 0.011), V(0.022), 0.33},
    TableMaterial{"polished granite", V(0.085, 0.078, 0.072), V(0.044), 0.030},
    TableMaterial{"honed marble", V(0.50, 0.48, 0.45), V(0.036), 0.14},
    TableMaterial{"terracotta", V(0.29, 0.11, 0.052), V(0.008), 0.46},
    TableMaterial{"glazed porcelain", V(0.60, 0.60, 0.57), V(0.042), 0.032},
    TableMaterial{"celadon glaze", V(0.21, 0.31, 0.25), V(0.041), 0.040},
    // Metals: little diffuse, a tinted lobe.
    TableMaterial{"brushed aluminium", V(0.080, 0.080, 0.082), V(0.30, 0.30, 0.31), 0.17},
    TableMaterial{"cast iron", V(0.018, 0.017, 0.016), V(0.065, 0.063, 0.060), 0.25},
    TableMaterial{"brushed brass", V(0.100, 0.070, 0.022), V(0.34, 0.25, 0.10), 0.19},
    TableMaterial{"matt copper", V(0.110, 0.050, 0.030), V(0.40, 0.22, 0.15), 0.23},
    TableMaterial{"satin nickel", V(0.040, 0.037, 0.032), V(0.24, 0.22, 0.19), 0.12},
    TableMaterial{"gold paint", V(0.16, 0.088, 0.021), V(0.17, 0.12, 0.045), 0.24},
};

}  // namespace

std::span<const TableMaterial> material_table() { return kMaterials; }

}  // namespace patina::scenes
