#pragma once
// Scenes that were loaded, shared by all views of them: another camera or resolution loads nothing.
#include <map>
#include <memory>
#include <string>

#include "pipeline/scene/scene.h"

namespace hwsim::lab {

/// Keeps none alive: whoever looks at a scene does.
class SceneShelf {
 public:
  /// Null where nobody looks at such a scene now.
  std::shared_ptr<const pipeline::Scene> find(const std::string& key) const {
    const auto found = scenes_.find(key);
    return found == scenes_.end() ? nullptr : found->second.lock();
  }
  void put(const std::string& key, const std::shared_ptr<const pipeline::Scene>& scene) {
    scenes_[key] = scene;
  }

 private:
  std::map<std::string, std::weak_ptr<const pipeline::Scene>> scenes_;
};

}  // namespace hwsim::lab
