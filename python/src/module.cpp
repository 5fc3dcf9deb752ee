#include "bindings.hpp"
#include "igsp/version.hpp"

NB_MODULE(_core, module) {
  using namespace igsp::python;
  module.doc() = "The C++ library as it is; the package igsp is the door to it.";
  module.attr("version") = igsp::version;
  bind_errors(module);
  bind_options(module);
  bind_result(module);
  bind_features(module);
  bind_viewpoint(module);
  bind_align(module);
  bind_similarity(module);
  bind_network(module);
  bind_diagnosis(module);
  bind_evaluation(module);
  bind_files(module);
  bind_archive(module);
  bind_simulation(module);
  bind_dask_engine(module);
  bind_command_line(module);
}
