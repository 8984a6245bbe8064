// Repose: scenes in Python.
#include "module.h"

namespace {

repose_scene_options scene_options(const std::string& quality, bool allow_outside_paths) {
  repose_scene_options options = repose_scene_options_init();
  if (quality == "draft") {
    options.quality = REPOSE_QUALITY_DRAFT;
  } else if (quality == "reference") {
    options.quality = REPOSE_QUALITY_REFERENCE;
  } else if (quality != "standard") {
    throw py::value_error("quality: choose among draft, standard, reference");
  }
  options.allow_outside_paths = allow_outside_paths ? 1 : 0;
  return options;
}

}  // namespace

void define_scene(py::module_& module) {
  using repose::Scene;
  py::class_<Scene>(module, "Scene", "A scene being put together, as the command reads it.")
      .def(py::init([](const std::string& folder) { return Scene::empty(folder); }), py::arg("folder") = ".",
           "A scene without a key, to be filled by set(); relative paths start at folder.")
      .def_static(
          "from_file",
          [](const std::string& path, const std::string& quality, bool outside) {
            return Scene::from_file(path, scene_options(quality, outside));
          },
          py::arg("path"), py::arg("quality") = "standard", py::arg("allow_outside_paths") = false,
          "Reads a scene file.")
      .def_static(
          "from_text",
          [](const std::string& text, const std::string& folder, const std::string& name,
             const std::string& quality,
             bool outside) { return Scene::from_text(text, folder, name, scene_options(quality, outside)); },
          py::arg("text"), py::arg("folder") = ".", py::arg("name") = "scene", py::arg("quality") = "standard",
          py::arg("allow_outside_paths") = false, "Reads a scene from text; errors call it by its name.")
      .def(
          "set",
          [](py::object self, const std::string& key, const py::object& value) {
            self.cast<Scene&>().set(key, json_of(value));
            return self;
          },
          py::arg("key"), py::arg("value"),
          "Sets a key (a path such as 'colliders.glass.friction'); text is JSON, else the value is made so.")
      .def("check", &Scene::check, "Reads the scene with all that was set.")
      .def("json", &Scene::json, "The scene as compact JSON, with expressions evaluated.")
      .def(
          "lead_pose",
          [](py::object self, const std::string& collider) {
            self.cast<Scene&>().lead_pose(collider);
            return self;
          },
          py::arg("collider"), "Says that move_collider will move it.")
      .def(
          "lead_mesh",
          [](py::object self, const std::string& collider, double rate) {
            self.cast<Scene&>().lead_mesh(collider, rate);
            return self;
          },
          py::arg("collider"), py::arg("rate"),
          "Says that deform_collider will give its mesh, rate times a second.")
      .def(
          "vdb_reader",
          [](py::object self, const std::string& program, double memory, double seconds) {
            self.cast<Scene&>().vdb_reader(program, memory, seconds);
            return self;
          },
          py::arg("program") = "", py::arg("memory") = 0.0, py::arg("seconds") = 0.0,
          "Says which program parses VDB files, and what it may take: bytes and seconds; 0 and '' are "
          "defaults.");
}
