#pragma once

#include <condition_variable>
#include <deque>
#include <future>
#include <mutex>
#include <thread>

#include "frontend/closing/graph_update.h"
#include "frontend/closing/node_pipeline.h"

namespace loopgrid {

/// The one place where the thread that tracks and the thread that closes loops meet: nodes go in,
/// and what each has changed in the graph comes out in the same order, whenever it is asked for.
class NodeQueue {
 public:
  /// `threaded`: nodes are treated on a thread of their own; otherwise at the moment that the
  /// update is asked for.
  explicit NodeQueue(bool threaded, const ClosingOptions& options = {});
  ~NodeQueue();
  NodeQueue(const NodeQueue&) = delete;
  NodeQueue& operator=(const NodeQueue&) = delete;

  void Submit(NewNode node);

  /// How many nodes have been submitted whose update has not been taken yet.
  int size() const { return static_cast<int>(updates_.size()); }

  /// Waits for the update of the oldest of them. Throws what the pipeline threw.
  GraphUpdate Take();

  /// See NodePipeline::Finish(). All updates have to be taken before.
  GraphUpdate Finish();

 private:
  void Serve();

  NodePipeline pipeline_;
  std::deque<std::future<GraphUpdate>> updates_;  // of the submitting thread alone
  std::mutex mutex_;                              // guards the next two
  std::deque<std::packaged_task<GraphUpdate()>> tasks_;
  bool is_ending_ = false;
  std::condition_variable wake_;
  std::thread thread_;
};

}  // namespace loopgrid
