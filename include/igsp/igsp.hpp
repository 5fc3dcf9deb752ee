#pragma once

#include "igsp/align.hpp"
#include "igsp/archive.hpp"
#include "igsp/diagnosis.hpp"
#include "igsp/errors.hpp"
#include "igsp/evaluation.hpp"
#include "igsp/io.hpp"
#include "igsp/network.hpp"
#include "igsp/similarity.hpp"
#include "igsp/simulation.hpp"
#include "igsp/version.hpp"
#include "igsp/viewpoint.hpp"
