#include "tests/support/browser.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <thread>

namespace loopgrid::test_support {
namespace {

using nlohmann::json;

constexpr auto kPatience = std::chrono::seconds(60);

bool IsInPath(const std::string& program) {
  const char* path = std::getenv("PATH");
  std::string rest = path == nullptr ? "" : path;
  while (!rest.empty()) {
    const std::size_t colon = std::min(rest.find(':'), rest.size());
    if (access((rest.substr(0, colon) + '/' + program).c_str(), X_OK) == 0) return true;
    rest.erase(0, colon + 1);
  }
  return false;
}

// Starts chromedriver as the leader of a process group. `output` is the end of a pipe to read its
// output from.
pid_t StartDriver(int* output) {
  std::array<int, 2> pipe_ends = {};
  if (pipe2(pipe_ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("cannot make a pipe");
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("cannot fork");
  if (child == 0) {
    setpgid(0, 0);
    dup2(pipe_ends[1], STDOUT_FILENO);
    dup2(open("/dev/null", O_WRONLY), STDERR_FILENO);
    execlp("chromedriver", "chromedriver", "--port=0", nullptr);
    _exit(127);
  }
  setpgid(child, child);
  close(pipe_ends[1]);
  *output = pipe_ends[0];
  return child;
}

// Starts a process that kills a process group when the other end of the pipe `life` is closed. That
// happens at the latest when this process ends, also if it is killed.
pid_t StartGuardian(pid_t group, int* life) {
  std::array<int, 2> pipe_ends = {};
  if (pipe2(pipe_ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("cannot make a pipe");
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("cannot fork");
  if (child == 0) {
    setpgid(0, 0);  // so that it does not get signals to the group of the tests, such as Ctrl-C
    const int nowhere = open("/dev/null", O_RDWR);
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(nowhere, stream);
    close(pipe_ends[1]);
    char byte = 0;
    while (read(pipe_ends[0], &byte, 1) != 0) continue;
    kill(-group, SIGKILL);
    _exit(0);
  }
  close(pipe_ends[0]);
  *life = pipe_ends[1];
  return child;
}

// "ChromeDriver was started successfully on port 40123."
int ReadPort(int output) {
  const std::string key = "successfully on port ";
  std::string printed;
  std::array<char, 256> bytes;
  while (printed.find('.', printed.find(key)) == std::string::npos ||
         printed.find(key) == std::string::npos) {
    const ssize_t count = read(output, bytes.data(), bytes.size());
    if (count <= 0) throw std::runtime_error("chromedriver does not start: " + printed);
    printed.append(bytes.data(), static_cast<std::size_t>(count));
  }
  return std::stoi(printed.substr(printed.find(key) + key.size()));
}

json Capabilities(const std::string& profile) {
  const json arguments = {"--headless",
                          "--no-sandbox",
                          "--disable-gpu",
                          "--disable-quic",
                          "--no-first-run",
                          "--disable-background-networking",
                          "--disable-component-update",
                          "--disable-sync",
                          "--disable-dev-shm-usage",
                          "--user-data-dir=" + profile};
  return {{"capabilities",
           {{"alwaysMatch",
             {{"browserName", "chrome"},
              {"goog:chromeOptions", {{"args", arguments}}},
              {"goog:loggingPrefs", {{"browser", "ALL"}, {"performance", "ALL"}}}}}}}};
}

std::string DecodeBase64(const std::string& text) {
  const std::string alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned bits = 0;
  int count = 0;
  for (char c : text.substr(0, text.find('='))) {
    bits = bits << 6 | static_cast<unsigned>(alphabet.find(c));
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count & 255);
  }
  return bytes;
}

}  // namespace

bool Browser::IsInstalled() { return IsInPath("chromium") && IsInPath("chromedriver"); }

Browser::Browser() {
  int output = -1;
  driver_ = StartDriver(&output);
  guardian_ = StartGuardian(driver_, &life_);
  client_ = std::make_unique<HttpClient>(ReadPort(output));  // the pipe stays open for later output
  const json session = Call("POST", "/session", Capabilities(profile_.path().string()));
  session_ = session.at("sessionId").get<std::string>();
}

Browser::~Browser() {
  try {
    CallSession("DELETE", "");
  } catch (const std::exception&) {  // the destructor goes on and ends it anyway
  }
  close(life_);
  waitpid(guardian_, nullptr, 0);
  waitpid(driver_, nullptr, 0);
}

json Browser::Call(const std::string& method, const std::string& path, const json& body) {
  HttpQuestion question{.method = method, .target = path};
  question.headers["Content-Type"] = "application/json";
  if (method == "POST") question.body = body.dump();
  const HttpReply reply = client_->Ask(question);
  json answer = json::parse(reply.body);
  if (reply.status != 200) {
    throw std::runtime_error(path + ": " + answer["value"]["message"].get<std::string>());
  }
  return answer["value"];
}

json Browser::CallSession(const std::string& method, const std::string& path, const json& body) {
  return Call(method, "/session/" + session_ + path, body);
}

void Browser::CallDevTools(const std::string& command, const json& parameters) {
  CallSession("POST", "/goog/cdp/execute", {{"cmd", command}, {"params", parameters}});
}

void Browser::Open(const std::string& url) { CallSession("POST", "/url", {{"url", url}}); }

json Browser::Run(const std::string& script) {
  return CallSession("POST", "/execute/sync", {{"script", script}, {"args", json::array()}});
}

bool Browser::WaitFor(const std::string& expression) {
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  while (Run("return Boolean(" + expression + ")") != true) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return true;
}

void Browser::Press(const std::vector<std::string>& keys) {
  json actions = json::array();
  for (const std::string& key : keys) {
    actions.push_back({{"type", "keyDown"}, {"value", key}});
    actions.push_back({{"type", "keyUp"}, {"value", key}});
  }
  const json keyboard = {{"type", "key"}, {"id", "keyboard"}, {"actions", actions}};
  CallSession("POST", "/actions", {{"actions", json::array({keyboard})}});
}

void Browser::Click(const std::string& selector) {
  const json element =
      CallSession("POST", "/element", {{"using", "css selector"}, {"value", selector}});
  CallSession("POST", "/element/" + element.begin().value().get<std::string>() + "/click");
}

void Browser::Resize(int width, int height, bool as_phone) {
  CallDevTools("Emulation.setDeviceMetricsOverride", {{"width", width},
                                                      {"height", height},
                                                      {"deviceScaleFactor", as_phone ? 2 : 1},
                                                      {"mobile", as_phone}});
  CallDevTools("Emulation.setTouchEmulationEnabled", {{"enabled", as_phone}});
}

void Browser::PreferDark(bool dark) {
  const json feature = {{"name", "prefers-color-scheme"}, {"value", dark ? "dark" : "light"}};
  CallDevTools("Emulation.setEmulatedMedia", {{"features", json::array({feature})}});
}

void Browser::SaveScreenshot(const std::string& path) {
  std::filesystem::create_directories(std::filesystem::path(path).parent_path());
  WriteFile(path, DecodeBase64(CallSession("GET", "/screenshot").get<std::string>()));
}

std::vector<json> Browser::TakeLog(const std::string& type) {
  return CallSession("POST", "/se/log", {{"type", type}}).get<std::vector<json>>();
}

std::vector<std::string> Browser::TakeComplaints() {
  std::vector<std::string> complaints;
  for (const json& entry : TakeLog("browser")) complaints.push_back(entry.at("message"));
  return complaints;
}

std::set<std::string> Browser::TakeHosts() {
  std::set<std::string> hosts;
  for (const json& entry : TakeLog("performance")) {
    const json message = json::parse(entry.at("message").get<std::string>()).at("message");
    if (message.at("method") != "Network.requestWillBeSent") continue;
    const std::string url = message.at("params").at("request").at("url");
    const std::size_t begin = url.find("://");
    if (begin == std::string::npos) continue;  // data: and blob:
    hosts.insert(url.substr(begin + 3, url.find('/', begin + 3) - begin - 3));
  }
  return hosts;
}

}  // namespace loopgrid::test_support
