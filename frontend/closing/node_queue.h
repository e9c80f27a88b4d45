#pragma once

#include <condition_variable>
#include <deque>
#include <future>
#include <mutex>
#include <thread>

#include "frontend/closing/graph_update.h"
#include "frontend/closing/node_pipeline.h"

namespace loopgrid {

/// Connects the thread that tracks with the thread that closes loops. Takes new nodes, and gives
/// the changes of the graph that each of them caused, in the same order.
class NodeQueue {
 public:
  /// `threaded`: nodes are processed on a second thread. Otherwise Take() processes them.
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
  std::deque<std::future<GraphUpdate>> updates_;  // used by the submitting thread only
  std::mutex mutex_;                              // guards the next two
  std::deque<std::packaged_task<GraphUpdate()>> tasks_;
  bool is_ending_ = false;
  std::condition_variable wake_;
  std::thread thread_;
};

}  // namespace loopgrid
