#pragma once

#include "network/engine.hpp"

namespace igsp::python {

/// The engine that igsp.command_engine makes of a Dask cluster.
cli::DaskEngine dask_engine();

}  // namespace igsp::python
