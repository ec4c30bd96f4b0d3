#include "pipeline/gltf/uri.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <system_error>

namespace hwsim::pipeline::gltf {
namespace {
namespace fs = std::filesystem;

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

int base64_digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+' || c == '-') return 62;
  if (c == '/' || c == '_') return 63;
  return -1;
}

std::optional<std::vector<std::uint8_t>> base64_decoded(std::string_view text) {
  std::vector<std::uint8_t> out;
  out.reserve(text.size() / 4 * 3 + 3);
  std::uint32_t bits = 0;
  int bit_count = 0;
  for (const char c : text) {
    if (c == '=') break;
    if (std::isspace(static_cast<unsigned char>(c))) continue;
    const int digit = base64_digit(c);
    if (digit < 0) return std::nullopt;
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    bit_count += 6;
    if (bit_count < 8) continue;
    bit_count -= 8;
    out.push_back(static_cast<std::uint8_t>(bits >> bit_count));
    bits &= (1u << bit_count) - 1;
  }
  return out;
}

// RFC 3986, of two letters at least: "file:", "https:".
bool has_scheme(std::string_view uri) {
  const std::size_t colon = uri.find(':');
  if (colon == std::string_view::npos || colon < 2) return false;
  return std::all_of(uri.begin(), uri.begin() + static_cast<std::ptrdiff_t>(colon), [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '+' || c == '-' || c == '.';
  });
}

// Component by component: /a/bc does not lie below /a/b.
bool lies_below(const fs::path& folder, const fs::path& file) {
  const auto [in_folder, in_file] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
  return in_folder == folder.end() && in_file != file.end();
}

FilePlace locate_name(const fs::path& folder, const std::string& name) {
  if (name.empty()) return {"", "names no file"};
  if (name.find('\0') != std::string::npos) return {"", "holds a NUL"};
  std::error_code error;
  const fs::path root = fs::weakly_canonical(folder, error);
  if (error) return {"", "cannot be found: " + error.message()};
  constexpr std::size_t kLongestComponent = 255;  // file systems in use have this limit
  for (const fs::path& component : fs::path(name))
    if (component.native().size() > kLongestComponent) return {"", "has a name longer than any file's"};
  const fs::path file = fs::weakly_canonical(root / name, error);
  if (error) return {"", "cannot be found: " + error.message()};
  if (!lies_below(root, file)) return {"", "lies outside of the scene's folder"};
  return {file.string(), ""};
}

}  // namespace

std::string percent_decoded(std::string_view uri) {
  std::string out;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] == '%' && i + 2 < uri.size() && hex_digit(uri[i + 1]) >= 0 && hex_digit(uri[i + 2]) >= 0) {
      out += static_cast<char>(hex_digit(uri[i + 1]) * 16 + hex_digit(uri[i + 2]));
      i += 2;
    } else {
      out += uri[i];
    }
  }
  return out;
}

bool is_data_uri(std::string_view uri) {
  constexpr std::string_view kScheme = "data:";
  return uri.size() >= kScheme.size() &&
         std::equal(kScheme.begin(), kScheme.end(), uri.begin(),
                    [](char a, char b) { return a == std::tolower(static_cast<unsigned char>(b)); });
}

std::optional<std::vector<std::uint8_t>> decode_data_uri(std::string_view uri) {
  const std::size_t comma = uri.find(',');
  if (comma == std::string_view::npos) return std::nullopt;
  const std::string_view type = uri.substr(0, comma);
  if (type.size() >= 7 && type.substr(type.size() - 7) == ";base64")
    return uri.find('%', comma) == std::string_view::npos
               ? base64_decoded(uri.substr(comma + 1))
               : base64_decoded(percent_decoded(uri.substr(comma + 1)));
  const std::string text = percent_decoded(uri.substr(comma + 1));
  return std::vector<std::uint8_t>(text.begin(), text.end());
}

FilePlace locate_file(const std::string& folder, std::string_view uri) {
  if (has_scheme(uri)) return {"", "is no path: only files beside the scene are read"};
  const FilePlace decoded = locate_name(folder, percent_decoded(uri));
  std::error_code error;
  if (!decoded.refusal.empty() || fs::exists(decoded.path, error)) return decoded;
  // Some exporters write names as they are: "100%25.png" may be the file's very name.
  const FilePlace plain = locate_name(folder, std::string(uri));
  return plain.refusal.empty() && fs::exists(plain.path, error) ? plain : decoded;
}

}  // namespace hwsim::pipeline::gltf
