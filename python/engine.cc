// The module tapa_mvs._engine: jobs.h as it stands, for the Python around it.
// Text is bytes, as names of files need not be UTF-8.

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>
#include <string>
#include <vector>

#include "python/jobs.h"

namespace py = pybind11;

namespace {

py::list Bytes(const std::vector<std::string>& lines) {
  py::list list;
  for (const std::string& line : lines) {
    list.append(py::bytes(line));
  }
  return list;
}

template <typename Task>
std::unique_ptr<tapa::Job> Start(const Task& task) {
  return std::make_unique<tapa::Job>(task);
}

}  // namespace

PYBIND11_MODULE(_engine, module) {
  using tapa::Job;
  const py::call_guard<py::gil_scoped_release> without_gil{};

  module.def("stereo_defaults", &tapa::StereoDefaults);
  module.def("fusion_defaults", &tapa::FusionDefaults);

  py::class_<Job>(module, "Job")
      .def("wait", &Job::Wait, without_gil)
      .def("stop", &Job::Stop, without_gil)
      .def("is_done", &Job::IsDone)
      .def("progress",
           [](const Job& job) {
             const auto [share, text] = job.Progress();
             return py::make_tuple(share, py::bytes(text));
           })
      .def("take_lines", [](Job& job) { return Bytes(job.TakeLines()); })
      .def("errors", [](const Job& job) { return Bytes(job.Errors()); });

  module.def(
      "start_stereo",
      [](std::string workspace_path, std::string workspace_format,
         std::string pmvs_option_name, std::string config_path,
         tapa::JobOptions options) {
        return Start(tapa::StereoTask{workspace_path, workspace_format,
                                      pmvs_option_name, config_path, options});
      },
      py::kw_only(), py::arg("workspace_path"), py::arg("workspace_format"),
      py::arg("pmvs_option_name"), py::arg("config_path"), py::arg("options"));
  module.def(
      "start_fusion",
      [](std::string workspace_path, std::string workspace_format,
         std::string pmvs_option_name, std::string input_type,
         std::string bbox_path, std::string output_path,
         tapa::JobOptions options) {
        return Start(tapa::FusionTask{workspace_path, workspace_format,
                                      pmvs_option_name, input_type, bbox_path,
                                      output_path, options});
      },
      py::kw_only(), py::arg("workspace_path"), py::arg("workspace_format"),
      py::arg("pmvs_option_name"), py::arg("input_type"), py::arg("bbox_path"),
      py::arg("output_path"), py::arg("options"));
}
