#include "network/link_graph.hpp"

#include <Eigen/Cholesky>

namespace igsp {

double loop_error(const LinkGraph& graph, std::span<const LinkStep> loop) {
  const GraphLink& first = graph.links[loop.front().link];
  const Eigen::Vector3d& centre = graph.centres[loop.front().forward ? first.source : first.target];
  Transformation start_from_here = Transformation::Identity();
  Matrix6 covariance = Matrix6::Zero();
  for (const LinkStep& step : loop) {
    const GraphLink& link = graph.links[step.link];
    // A link errs in its target's frame.
    if (step.forward) start_from_here = start_from_here * link.target_from_source.inverse();
    const Matrix6 to_start = transport(start_from_here, link.centre, centre);
    covariance += to_start * link.tolerance * to_start.transpose();
    if (!step.forward) start_from_here = start_from_here * link.target_from_source;
  }
  const Vector6 error = step_about(centre, start_from_here.inverse());
  return error.dot(covariance.ldlt().solve(error));
}

}  // namespace igsp
