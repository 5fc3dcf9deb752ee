// The raw figures of the paper's evaluation, docs/paper/: `make paper` calls the subcommands in this order.
//   igsp_paper pairs --scans ../shared/data --pairs build/paper/pairs
//   igsp_paper registrations|parameters --pairs build/paper/pairs --data docs/paper/data
//   igsp_paper growth --data docs/paper/data

#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>

#include "pairs.hpp"
#include "tables.hpp"

int main(int argc, char** argv) {
  std::filesystem::path scans, pairs, data;
  CLI::App app("Raw figures of the paper's evaluation");
  app.require_subcommand(1);
  CLI::App* write_pairs = app.add_subcommand("pairs", "writes the clouds and their true relations");
  CLI::App* registrations = app.add_subcommand("registrations", "Tables 3 and 4, Fig. 4 and 8");
  CLI::App* parameters = app.add_subcommand("parameters", "Fig. 3");
  CLI::App* growth = app.add_subcommand("growth", "cost of an iteration over the number of keypoints");
  write_pairs->add_option("--scans", scans, "folder of real scans with their cases.csv")->required();
  for (CLI::App* command : {write_pairs, registrations, parameters}) {
    command->add_option("--pairs", pairs, "folder of the pairs")->required();
  }
  for (CLI::App* command : {registrations, parameters, growth}) {
    command->add_option("--data", data, "folder for the CSV files")->required();
  }
  CLI11_PARSE(app, argc, argv);
  try {
    if (*write_pairs) igsp::paper::write_pairs(scans, pairs);
    if (*registrations) igsp::paper::write_registrations(pairs, data);
    if (*parameters) igsp::paper::write_parameters(pairs, data);
    if (*growth) igsp::paper::write_growth(data);
  } catch (const std::exception& error) {
    std::cerr << "igsp_paper: " << error.what() << "\n";
    return 1;
  }
}
