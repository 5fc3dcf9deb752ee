#pragma once

#include "registration/prepared_cloud.hpp"
#include "registration/verdict.hpp"

namespace igsp {

/// The sentence with the evidence for the verdict. What is refused without a direction that the surfaces leave free at
/// the pose gets those that the target alone leaves free.
void give_reason(const PreparedCloud& target, const Doubts& doubts, Result& result);

}  // namespace igsp
