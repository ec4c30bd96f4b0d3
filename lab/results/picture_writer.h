#pragma once
// The pictures of points, written beside what comes next.
#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "lab/point/simulate.h"

namespace hwsim::lab {

/// Files are the same whether written here or there. A reference is encoded once for all points, and must
/// outlive the writer.
class PictureWriter {
 public:
  /// One of `jobs` threads is for pictures; with a single one each is written at once.
  explicit PictureWriter(int jobs);
  /// What still waits is not written.
  ~PictureWriter();
  PictureWriter(const PictureWriter&) = delete;
  PictureWriter& operator=(const PictureWriter&) = delete;

  /// color.png and .exr, heat_shading.png, and with a reference its own and those of the error. Throws what
  /// kept an earlier picture from being written. Waits while those of two points do: they take 30 MB each at
  /// 1280x720.
  void write(const std::string& folder, const PointResult& point, const ReferenceImage* reference);

  /// Writes what waits, in this thread too.
  void finish();

 private:
  using Task = std::function<void()>;
  struct EncodedReference;

  void add(Task task);
  void work();
  bool run_one(std::unique_lock<std::mutex>& lock);

  std::shared_ptr<EncodedReference> reference_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Task> waiting_;
  std::size_t running_ = 0;
  std::exception_ptr failure_;
  bool ends_ = false;
  std::thread thread_;
};

}  // namespace hwsim::lab
