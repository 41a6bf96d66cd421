#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "lobe/device/device.hpp"
#include "view/scenes.hpp"
#include "view/shown.hpp"

namespace lobe::cli {

/// Serves the page to browsers of this machine, and its questions. Everything lies below a secret path, and nothing is
/// served to those who do not know it, nor under another host's name.
class ViewServer {
 public:
  /// Takes a port of 127.0.0.1.
  /// \param port 0: any that is free
  /// \throws IoError for a port that cannot be had
  ViewServer(const Device& device, ShownMaterials& shown, ShownScenes& scenes, std::size_t first_shown, int port);
  ~ViewServer();
  ViewServer(const ViewServer&) = delete;
  ViewServer& operator=(const ViewServer&) = delete;

  /// "http://127.0.0.1:8080/0123456789abcdef0123456789abcdef/"
  [[nodiscard]] std::string address() const;

  /// Serves until `is_over` says so, which is asked many times a second. Answers are computed on the calling thread.
  void serve(const std::function<bool()>& is_over);

 private:
  struct Content;
  std::unique_ptr<Content> content_;
};

}  // namespace lobe::cli
