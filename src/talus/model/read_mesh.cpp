#include "talus/model/read_mesh.h"

#include <cmath>
#include <filesystem>

#include "talus/base/error.h"
#include "talus/base/text_file.h"
#include "talus/geometry/polygon_check.h"
#include "talus/model/map_input.h"
#include "talus/model/model_sections.h"

namespace talus {

namespace {

class MeshReader : private ModelSections {
 public:
  MeshReader(const TomlSource& source, std::set<std::string>& block_names, Model& model, Findings& findings)
      : ModelSections(source, model, findings), block_names_(block_names) {}

  std::string read() {
    for_list("mesh", [this](const Fields& f) { read_mesh(f); });
    return std::move(files_);
  }

 private:
  void read_mesh(const Fields& f) {
    claim_name(f, block_names_, "block, grid or mesh");
    auto m = f.filled<MeshInput>();
    m.material = refer(f, "material", model_.materials, "material");
    m.joint = refer(f, "joint", model_.joints, "joint");
    if (!f.has("file") || !f.has("name") || !read_file(f, m.mesh)) {
      model_.shapes_readable = false;
      return;
    }
    for (Vec2& p : m.mesh.node) p = drawing_unit(f.get<std::string>("unit", "m")) * p;
    if (const Placement place = placement(f); place.is_given()) {
      const Box box = bounding_box(m.mesh.node);
      for (Vec2& p : m.mesh.node) p = place.apply(p, 0.5 * (box.min + box.max));
    }
    check_elements(f, m);
    name_groups(f, m);
    model_.meshes.push_back(std::move(m));
  }

  bool read_file(const Fields& f, Mesh& mesh) {
    const auto path = std::filesystem::path(model_.folder) / f.get<std::string>("file");
    try {
      const std::string text = read_text_file(path);
      files_ += text;
      model_.files.push_back({path.string(), text_hash(text)});
      mesh = read_msh(path.string(), text);
      return true;
    } catch (const FileError& e) {
      if (std::error_code ec; std::filesystem::is_regular_file(path, ec))
        throw;  // there, and not to be read now
      error(f, "file", e.what(), "the path counts from the folder of the model file");
    } catch (const InputError& e) {
      error(f, "file", std::string("cannot be read\n") + e.what());
    }
    return false;
  }

  // Elements that are no blocks: quadrilaterals that cross themselves, corners that lie on each other.
  void check_elements(const Fields& f, const MeshInput& m) {
    for (const MeshElement& e : m.mesh.elements) {
      const std::string defect = polygon_defect(m.polygon(e));
      if (defect.empty()) continue;
      error(f, "file", fmt::format("element {}: {}", e.tag, defect), "mesh it again");
      model_.shapes_readable = false;
      return;
    }
  }

  // Groups of surfaces give materials and groups of blocks, those of curves joints and names for supports.
  void name_groups(const Fields& f, MeshInput& m) {
    const auto sound = [&](const std::string& name) {
      const std::string defect = name_defect(name);
      if (defect.empty()) return true;
      error(f, "file", fmt::format("\"{}\" is no name of a physical group: {}", shown_name(name), defect));
      return false;
    };
    bool needs_default = false;
    for (const MeshElement& e : m.mesh.elements) needs_default = needs_default || e.group < 0;
    for (const std::string& group : m.mesh.surface_groups) {
      if (!sound(group)) continue;
      if (!block_names_.insert(m.name + "-" + group).second)
        error(f, "name", fmt::format("its group \"{}-{}\" has the name of other blocks", m.name, group));
      const int named = index_of(model_.materials, group);
      m.group_material.push_back(named >= 0 ? named : m.material);
      if (named < 0 && m.material < 0 && !f.given("material"))
        findings_.error(
            f.where(), f.path_of("material"),
            fmt::format("is missing: no [material.{}] for its physical group \"{}\"", group, group),
            "name materials like the groups, or give material for the rest");
    }
    if (needs_default && m.material < 0 && !f.given("material"))
      findings_.error(f.where(), f.path_of("material"),
                      "is missing: not all elements are in a physical group");
    for (const std::string& group : m.mesh.curve_groups) {
      sound(group);
      m.curve_joint.push_back(index_of(model_.joints, group));
    }
  }

  std::set<std::string>& block_names_;
  std::string files_;
};

}  // namespace

Polygon MeshInput::polygon(const MeshElement& e) const {
  Polygon out;
  for (int k = 0; k < e.corners; ++k) out.push_back(mesh.node[e.node[k]]);
  return out;
}

std::string read_mesh_sections(const TomlSource& source, std::set<std::string>& block_names, Model& model,
                               Findings& findings) {
  return MeshReader(source, block_names, model, findings).read();
}

}  // namespace talus
