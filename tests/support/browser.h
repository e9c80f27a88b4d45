#pragma once

#include <sys/types.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "tests/support/http_client.h"
#include "tests/support/temporary_directory.h"

namespace loopgrid::test_support {

/// Headless Chromium with a profile of its own, controlled through chromedriver by the WebDriver
/// protocol (W3C). Failures throw std::runtime_error.
class Browser {
 public:
  /// Whether chromium and chromedriver are installed.
  static bool IsInstalled();

  Browser();
  ~Browser();
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

  void Open(const std::string& url);

  /// Runs the body of a function in the page. Returns its result.
  nlohmann::json Run(const std::string& script);

  /// Waits until an expression of the page is true; false if it is not within a minute.
  bool WaitFor(const std::string& expression);

  /// Presses keys one after another, as a user does. Special ones: U+E000 and so on, see WebDriver.
  void Press(const std::vector<std::string>& keys);

  /// Clicks in the middle of the element that a CSS selector finds.
  void Click(const std::string& selector);

  /// Sets the size of the page in CSS pixels. As a phone it has two device pixels for each of them,
  /// and touch.
  void Resize(int width, int height, bool as_phone = false);
  void PreferDark(bool dark);

  void SaveScreenshot(const std::string& path);

  /// Messages on the page's console since the last call.
  std::vector<std::string> TakeComplaints();

  /// Hosts (with ports) to which the page has sent requests since the last call.
  std::set<std::string> TakeHosts();

 private:
  nlohmann::json Call(const std::string& method, const std::string& path,
                      const nlohmann::json& body = nlohmann::json::object());
  nlohmann::json CallSession(const std::string& method, const std::string& path,
                             const nlohmann::json& body = nlohmann::json::object());
  void CallDevTools(const std::string& command, const nlohmann::json& parameters);
  std::vector<nlohmann::json> TakeLog(const std::string& type);

  TemporaryDirectory profile_;
  pid_t driver_ = -1;
  pid_t guardian_ = -1;  // ends the driver and the browser when this process is gone
  int life_ = -1;  // the pipe that the guardian watches; closed by us, or when this process ends
  std::unique_ptr<HttpClient> client_;
  std::string session_;
};

}  // namespace loopgrid::test_support
