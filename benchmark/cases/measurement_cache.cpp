#include "measurement_cache.hpp"

#include <iostream>

namespace organ_collision::bench {

const Scene& MeasurementCache::scene(const SceneKey& key) {
  std::unique_ptr<Scene>& scene = scenes_[key];
  if (!scene) {
    scene = std::make_unique<Scene>(key.shuffled ? this->scene({key.faces, false}).shuffled()
                                                 : Scene(key.faces));
  }
  return *scene;
}

EngineMeasurement& MeasurementCache::engine(const std::string& engine,
                                            std::unique_ptr<Engine> (*make)(), const SceneKey& key,
                                            bool rigid) {
  std::unique_ptr<EngineMeasurement>& measurement = engines_[{engine, key, rigid}];
  if (!measurement) {
    measurement = std::make_unique<EngineMeasurement>(make(), scene(key), rigid);
    report_check(engine + (rigid ? ", rigid" : ""), key, measurement->summary());
  }
  return *measurement;
}

ContactMeasurement& MeasurementCache::contacts(const SceneKey& key) {
  std::unique_ptr<ContactMeasurement>& measurement = contacts_[key];
  if (!measurement) {
    measurement = std::make_unique<ContactMeasurement>(scene(key));
    report_check("ours, contacts", key, measurement->summary());
  }
  return *measurement;
}

GrasperMeasurement& MeasurementCache::grasper() {
  if (!grasper_) grasper_ = std::make_unique<GrasperMeasurement>();
  return *grasper_;
}

WhereMeasurement& MeasurementCache::where(const std::string& locator,
                                          std::unique_ptr<Locator> (*make)(), const SceneKey& key) {
  std::unique_ptr<WhereMeasurement>& measurement = where_[{locator, key}];
  if (!measurement) {
    measurement = std::make_unique<WhereMeasurement>(make(), scene(key));
    report_check(locator + ", where the tool is", key, measurement->summary());
  }
  return *measurement;
}

void MeasurementCache::report_check(const std::string& name, const SceneKey& key,
                                    const CheckSummary& summary) {
  const auto& [missed, wrong] = summary.errors;
  if (name.rfind("ours", 0) == 0) own_errors_ += missed + wrong;
  std::cerr << "checked " << name << ", " << key.faces << " faces"
            << (key.shuffled ? ", shuffled: " : ": ") << summary.hits << " hits a query, missed "
            << missed << ", wrong " << wrong << " in all" << std::endl;
}

}  // namespace organ_collision::bench
