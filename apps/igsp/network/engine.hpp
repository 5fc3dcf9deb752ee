#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>

#include "igsp/errors.hpp"
#include "igsp/features.hpp"
#include "igsp/network.hpp"
#include "network/inputs.hpp"

namespace igsp::cli {

/// Who reads the scans of a network, makes their features and registers pairs: this process, or workers elsewhere. What
/// follows from the answers is decided here. Scans are indices into ScanReading::files. All may throw EngineLost, those
/// of a scan FileError and InvalidArgument where it is to blame.
class Engine {
 public:
  using Keep = std::function<void(const ScanPair& pair, const Result& result)>;

  virtual ~Engine() = default;
  virtual ScanLook look(std::size_t scan, const Options& options, const ProgressCallback& progress) = 0;

  /// Of the content of its file, see network/fingerprint.hpp.
  virtual std::string fingerprint(std::size_t scan, const ProgressCallback& progress) = 0;
  virtual Features features(std::size_t scan, const Options& options, const ProgressCallback& progress) = 0;

  /// Whether many scans are worked on at once, so that it should be told ahead which features are asked for.
  virtual bool works_ahead() const { return false; }
  virtual void expect(std::span<const std::size_t> /*scans*/, const Options& /*options*/) {}

  /// Registers pairs elsewhere. Those that it does not hand to `keep` are registered by this process.
  virtual void register_pairs(std::span<const ScanPair> /*pairs*/, const Options& /*options*/, const Keep& /*keep*/,
                              const std::function<void(double)>& /*report*/) {}
};

/// The workers are gone for good. Ends a run of register_network, where a FileError would be one scan's problem.
class EngineLost : public Cancelled {
 public:
  explicit EngineLost(std::string message) : message_(std::move(message)) {}
  const char* what() const noexcept override { return message_.c_str(); }

 private:
  std::string message_;
};

/// Threads of this process. `reading` must outlive it.
std::unique_ptr<Engine> local_engine(const ScanReading& reading);

/// Takes a line for the user.
using Warn = std::function<void(const std::string& line)>;

/// Makes the engine of a Dask cluster whose scheduler has this address; throws FileError.
using DaskEngine =
    std::function<std::unique_ptr<Engine>(const std::string& scheduler, const ScanReading& reading, const Warn& warn)>;

/// That of this process: the Python package has one, the plain command none. Set before any command runs.
void use_dask_engine(DaskEngine engine);

/// Throws InvalidArgument where this process has none.
std::unique_ptr<Engine> dask_engine(const std::string& scheduler, const ScanReading& reading, const Warn& warn);

}  // namespace igsp::cli
