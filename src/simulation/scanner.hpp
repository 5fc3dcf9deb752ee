#pragma once

#include "igsp/point_cloud.hpp"
#include "simulation/scene.hpp"

namespace igsp::simulation {

Eigen::Vector3d direction_of(double azimuth_rad, double elevation_rad);

/// About `count` directions of the terrestrial scanner's regular angular grid: full azimuth, elevation -60 to 85
/// degrees.
Points scan_directions(int count);

/// About `count` points from the station, in its own frame: regular rays, jittered slightly, each point displaced along
/// its ray by Gaussian noise. Rays that meet nothing within range, or a surface at a grazing angle, return nothing.
Points scan(const Scene& scene, const Transformation& world_from_scanner, int count, double noise, Random random);

}  // namespace igsp::simulation
