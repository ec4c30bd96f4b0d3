#pragma once
// What the clock of the detailed engine goes through: events of subgroups, in the order of their time.
#include <cstdint>
#include <queue>

namespace hwsim {

enum class Step : unsigned char { work, fetch, more, leave, release };

struct Event {
  double ns;
  std::uint64_t number;  ///< ties in the order in which they were made
  std::uint32_t subgroup;
  Step step;
  bool operator<(const Event& b) const { return ns != b.ns ? ns > b.ns : number > b.number; }
};

class Events {
 public:
  bool empty() const { return queue_.empty(); }
  void push(double ns, std::uint32_t subgroup, Step step) { queue_.push({ns, number_++, subgroup, step}); }
  Event pop() {
    const Event event = queue_.top();
    queue_.pop();
    return event;
  }

 private:
  std::priority_queue<Event> queue_;
  std::uint64_t number_ = 0;
};

}  // namespace hwsim
