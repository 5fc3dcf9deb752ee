#include "network/engine.hpp"

#include "files/foreign_formats.hpp"
#include "igsp/errors.hpp"
#include "network/fingerprint.hpp"

namespace igsp::cli {
namespace {

class LocalEngine : public Engine {
 public:
  explicit LocalEngine(const ScanReading& reading) : reading_(reading) {}

  ScanLook look(std::size_t scan, const Options& options, const ProgressCallback& progress) override {
    return look_at_scan(reading_, scan, options.scale, progress);
  }
  std::string fingerprint(std::size_t scan, const ProgressCallback&) override {
    return fingerprint_of_file(file_of_scan(reading_.files[scan]));
  }
  Features features(std::size_t scan, const Options& options, const ProgressCallback& progress) override {
    return read_features(reading_, scan, options, progress);
  }

 private:
  const ScanReading& reading_;
};

DaskEngine& dask_engine_of_process() {
  static DaskEngine engine;
  return engine;
}

}  // namespace

std::unique_ptr<Engine> local_engine(const ScanReading& reading) {
  return std::make_unique<LocalEngine>(reading);
}

void use_dask_engine(DaskEngine engine) {
  dask_engine_of_process() = std::move(engine);
}

std::unique_ptr<Engine> dask_engine(const std::string& scheduler, const ScanReading& reading, const Warn& warn) {
  if (!dask_engine_of_process()) {
    throw InvalidArgument(
        "--engine dask comes with the Python package: pip install 'igsp[dask]' brings an igsp command that has it");
  }
  return dask_engine_of_process()(scheduler, reading, warn);
}

}  // namespace igsp::cli
