// Makes the documentation site of what pandoc, Doxygen and lobe_make_pages have made: puts pages into the template with
// navigation and contents, points links at the pages' places, copies what they show, and writes the index of the
// search. A page in no group of the navigation, and a link that leads nowhere, is a mistake: a line each, and exit
// status 1. usage: lobe_make_site REPOSITORY FRAGMENTS SITE
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace {

namespace fs = std::filesystem;

std::string read(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  if (!file) throw std::runtime_error("cannot read " + path.string());
  return std::move(text).str();
}

void write(const fs::path& path, std::string_view text) {
  fs::create_directories(path.parent_path());
  std::ofstream file(path, std::ios::binary);
  file << text;
  if (!file.flush()) throw std::runtime_error("cannot write " + path.string());
}

std::string replaced(std::string text, std::string_view what, std::string_view by) {
  for (std::size_t at = text.find(what); at != text.npos; at = text.find(what, at + by.size())) {
    text.replace(at, what.size(), by);
  }
  return text;
}

/// What HTML shows, without its marks.
std::string plain(std::string_view html) {
  std::string text;
  bool is_mark = false;
  for (const char c : replaced(std::string(html), "</td>", " ")) {
    if (c == '<' || c == '>') {
      is_mark = c == '<';
      continue;
    }
    if (is_mark) continue;
    const bool is_blank = std::isspace(static_cast<unsigned char>(c)) != 0;
    if (!is_blank || (!text.empty() && text.back() != ' ')) text += is_blank ? ' ' : c;
  }
  for (const auto& [name, character] :
       {std::pair{"&lt;", "<"}, {"&gt;", ">"}, {"&quot;", "\""}, {"&#39;", "'"}, {"&amp;", "&"}}) {
    text = replaced(std::move(text), name, character);
  }
  return text;
}

/// A mark of HTML from its '<' to after its '>'.
struct Mark {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// The next mark from a place on; begin is npos where there is none.
Mark next_mark(std::string_view html, std::size_t from) {
  const std::size_t begin = html.find('<', from);
  const std::size_t end = begin == html.npos ? html.npos : html.find('>', begin);
  return end == html.npos ? Mark{html.npos, html.npos} : Mark{begin, end + 1};
}

/// Place and length of the value of a mark's attribute; a place of npos where it has none.
std::pair<std::size_t, std::size_t> attribute(std::string_view html, Mark mark, std::string_view name) {
  const std::string_view text = html.substr(mark.begin, mark.end - mark.begin);
  const std::string key = std::string(name) + "=\"";
  for (std::size_t at = text.find(key); at != text.npos; at = text.find(key, at + 1)) {
    if (std::isspace(static_cast<unsigned char>(text[at - 1])) == 0) continue;
    const std::size_t begin = at + key.size();
    const std::size_t end = text.find('"', begin);
    if (end != text.npos) return {mark.begin + begin, end - begin};
  }
  return {html.npos, 0};
}

std::set<std::string> anchors_of(std::string_view html) {
  std::set<std::string> anchors;
  for (Mark mark = next_mark(html, 0); mark.begin != html.npos; mark = next_mark(html, mark.end)) {
    for (const auto* name : {"id", "name"}) {
      const auto [at, length] = attribute(html, mark, name);
      if (at != html.npos) anchors.emplace(html.substr(at, length));
    }
  }
  return anchors;
}

struct Heading {
  int level = 1;
  std::string anchor;
  std::string html;
  std::size_t begin = 0;  ///< of its marks in the page
  std::size_t end = 0;
};

/// Headings that can be linked to.
std::vector<Heading> headings_of(std::string_view html) {
  std::vector<Heading> headings;
  for (Mark mark = next_mark(html, 0); mark.begin != html.npos; mark = next_mark(html, mark.end)) {
    const bool is_heading = html[mark.begin + 1] == 'h' && std::isdigit(html[mark.begin + 2]) != 0;
    if (!is_heading) continue;
    const std::string close = std::string("</h") + html[mark.begin + 2] + ">";
    const std::size_t end = html.find(close, mark.end);
    if (end == html.npos) continue;
    const auto [at, length] = attribute(html, mark, "id");
    headings.push_back({html[mark.begin + 2] - '0', at == html.npos ? "" : std::string(html.substr(at, length)),
                        std::string(html.substr(mark.end, end - mark.end)), mark.begin, end + close.size()});
  }
  return headings;
}

struct Page {
  std::string source;  ///< path in the repository, or in the site for what is generated; links are read from there
  std::string url;     ///< path in the site
  std::string label;   ///< in the navigation
  std::size_t group = 0;
  std::string folder = {};  ///< of pages that stand below an entry of the navigation: that entry's source
  std::string html = {};
};

struct Group {
  std::string title;
  std::vector<std::pair<std::string, std::string>> entries;  ///< source and label
};

/// docs/site/navigation: "[Title]" begins a group, other lines are a page and its label.
std::vector<Group> read_navigation(const fs::path& path) {
  std::vector<Group> groups;
  std::istringstream lines(read(path));
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    if (line.empty() || line.front() == '#') continue;
    if (line.front() == '[') {
      groups.push_back({line.substr(1, line.find(']') - 1), {}});
      continue;
    }
    const std::size_t end = line.find(' ');
    const std::size_t label = line.find_first_not_of(' ', end);
    if (groups.empty() || end == line.npos || label == line.npos) {
      throw std::runtime_error(path.string() + ":" + std::to_string(number) + ": expected [GROUP] or PAGE LABEL");
    }
    groups.back().entries.emplace_back(line.substr(0, end), line.substr(label));
  }
  return groups;
}

/// docs/tutorial.md is shown as tutorial.html, README.md as index.html.
std::string url_of(const std::string& source) {
  if (source == "README.md") return "index.html";
  if (source.ends_with('/')) return source + "index.html";
  if (!source.ends_with(".md")) return source;
  std::string name = fs::path(source).stem();
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return name + ".html";
}

std::string relative(const std::string& url, const std::string& from) {
  return fs::path(url).lexically_relative(fs::path(from).parent_path()).string();
}

class Site {
 public:
  Site(fs::path repository, fs::path fragments, fs::path output)
      : repository_(std::move(repository)), fragments_(std::move(fragments)), output_(std::move(output)) {}

  void make() {
    groups_ = read_navigation(repository_ / "docs/site/navigation");
    collect_pages();
    for (auto& page : pages_) place_links(page);
    check_anchors();
    if (!mistakes_.empty()) return;
    const std::string page_template = read(repository_ / "docs/site/template.html");
    for (std::size_t i = 0; i < pages_.size(); ++i) write(output_ / pages_[i].url, filled(page_template, i));
    write(output_ / "search-index.js", search_index());
    for (const auto* file : {"style.css", "site.js"}) write(output_ / file, read(repository_ / "docs/site" / file));
  }

  [[nodiscard]] const std::vector<std::string>& mistakes() const { return mistakes_; }
  [[nodiscard]] std::size_t pages() const { return pages_.size(); }

 private:
  void add(Page page) {
    const fs::path path =
        fragments_ / fs::path(page.source.ends_with('/') ? page.url : page.source).replace_extension(".html");
    if (!fs::exists(path)) {
      mistakes_.push_back("docs/site/navigation: there is no " + page.source);
      return;
    }
    page.html = read(path);
    if (page.source.ends_with('/')) page.source += "index.html";
    place_of_[page.source] = pages_.size();
    pages_.push_back(std::move(page));
  }

  void collect_pages() {
    std::set<std::string> listed;
    for (std::size_t group = 0; group < groups_.size(); ++group) {
      for (const auto& [source, label] : groups_[group].entries) {
        listed.insert(source);
        if (source == "api/") continue;  // Doxygen's pages have a frame of their own
        add({source, url_of(source), label, group});
        if (!source.ends_with('/')) continue;
        std::vector<std::string> names;
        for (const auto& entry : fs::directory_iterator(fragments_ / source)) {
          const std::string name = entry.path().filename();
          if (name.ends_with(".html") && name != "index.html") names.push_back(name);
        }
        std::ranges::sort(names);
        for (const auto& name : names) add({source + name, source + name, fs::path(name).stem(), group, source});
      }
    }
    for (const auto& entry : fs::directory_iterator(repository_ / "docs")) {
      const std::string source = "docs/" + entry.path().filename().string();
      if (source.ends_with(".md") && !listed.contains(source)) {
        mistakes_.push_back(source + ": in no group of docs/site/navigation");
      }
    }
  }

  /// "docs/tutorial.md:12" where the source has that link, else the source alone.
  [[nodiscard]] std::string place(const Page& page, const std::string& link) const {
    const fs::path path = repository_ / page.source;
    if (!fs::exists(path)) return page.source;
    std::istringstream lines(read(path));
    std::string line;
    for (int number = 1; std::getline(lines, line); ++number) {
      if (line.find("(" + link) != line.npos) return page.source + ":" + std::to_string(number);
    }
    return page.source;
  }

  /// Where in the site a link of a page leads; what it leads to is copied unless it is a page. Empty: nowhere.
  std::string target(const Page& page, const std::string& path) {
    if (path.empty()) return page.url;
    const std::string source = (fs::path(page.source).parent_path() / path).lexically_normal();
    for (const auto& name : {source, source + ".md"}) {
      if (const auto found = place_of_.find(name); found != place_of_.end()) return pages_[found->second].url;
    }
    if (source.starts_with("api/") && fs::exists(output_ / source)) return source;
    for (const auto& [root, is_source] : {std::pair{fragments_, false}, {repository_, true}}) {
      if (source.starts_with("..") || !fs::is_regular_file(root / source)) continue;
      std::string url = source;
      const std::string ending = fs::path(source).extension();
      const bool is_picture = ending == ".png" || ending == ".svg";
      if (is_source && is_picture && source.starts_with("docs/")) url = source.substr(5);
      // Browsers save what they do not know the ending of.
      if (is_source && !is_picture) url = "files/" + source + ".txt";
      fs::create_directories((output_ / url).parent_path());
      fs::copy_file(root / source, output_ / url, fs::copy_options::overwrite_existing);
      return url;
    }
    return "";
  }

  void place_links(Page& page) {
    for (Mark mark = next_mark(page.html, 0); mark.begin != page.html.npos; mark = next_mark(page.html, mark.end)) {
      for (const auto* name : {"href", "src"}) {
        const auto [at, length] = attribute(page.html, mark, name);
        if (at == page.html.npos) continue;
        const std::string link = page.html.substr(at, length);
        if (link.find(':') != link.npos) continue;  // elsewhere
        const std::size_t hash = std::min(link.find('#'), link.size());
        const std::string url = target(page, link.substr(0, hash));
        if (url.empty()) {
          mistakes_.push_back(place(page, link) + ": there is no " + link.substr(0, hash));
          continue;
        }
        if (hash < link.size()) links_.push_back({place_of_.at(page.source), link, url, link.substr(hash + 1)});
        const std::string placed = (hash == 0 ? "" : relative(url, page.url)) + link.substr(hash);
        page.html.replace(at, length, placed);
        mark.end += placed.size() - length;
      }
    }
  }

  void check_anchors() {
    std::map<std::string, std::set<std::string>> anchors;
    for (const auto& page : pages_) anchors[page.url] = anchors_of(page.html);
    for (const auto& link : links_) {
      if (!anchors.contains(link.url)) anchors[link.url] = anchors_of(read(output_ / link.url));
      if (!anchors[link.url].contains(link.anchor)) {
        mistakes_.push_back(place(pages_[link.page], link.text) + ": " + link.url + " has no #" + link.anchor);
      }
    }
  }

  [[nodiscard]] std::string navigation(const Page& page) const {
    std::string html;
    for (std::size_t group = 0; group < groups_.size(); ++group) {
      html += "<section><h2>" + groups_[group].title + "</h2><ul>\n";
      for (const auto& [source, label] : groups_[group].entries) {
        const bool is_here = page.url == url_of(source);
        html += "<li><a" + std::string(is_here ? " aria-current=\"page\"" : "") + " href=\"" +
                relative(url_of(source), page.url) + "\">" + label + "</a>";
        if (source.ends_with('/') && (page.folder == source || is_here)) html += children(page, source);
        html += "</li>\n";
      }
      html += "</ul></section>\n";
    }
    return html;
  }

  [[nodiscard]] std::string children(const Page& page, const std::string& folder) const {
    std::string html = "<ul>\n";
    for (const auto& child : pages_) {
      if (child.folder != folder) continue;
      html += "<li><a" + std::string(child.url == page.url ? " aria-current=\"page\"" : "") + " href=\"" +
              relative(child.url, page.url) + "\">" + replaced(child.label, "_", "_<wbr>") + "</a></li>\n";
    }
    return html + "</ul>";
  }

  [[nodiscard]] static std::string contents(const std::vector<Heading>& headings) {
    std::string html;
    for (const auto& heading : headings) {
      if (heading.level < 2 || heading.level > 3 || heading.anchor.empty()) continue;
      html += "<li class=\"level-" + std::to_string(heading.level) + "\"><a href=\"#" + heading.anchor + "\">" +
              plain_markup(heading.html) + "</a></li>\n";
    }
    return html.empty() ? "" : "<h2>On this page</h2><ul>\n" + html + "</ul>";
  }

  [[nodiscard]] static std::string plain_markup(std::string_view html) {
    return replaced(replaced(replaced(plain(html), "&", "&amp;"), "<", "&lt;"), ">", "&gt;");
  }

  /// A link to the page before or after.
  [[nodiscard]] std::string neighbour(std::size_t at, int step) const {
    if ((step < 0 && at == 0) || at + static_cast<std::size_t>(step) >= pages_.size()) return "";
    const Page& other = pages_[at + static_cast<std::size_t>(step)];
    return std::string("<a rel=\"") + (step < 0 ? "prev" : "next") + "\" href=\"" +
           relative(other.url, pages_[at].url) + "\"><small>" + (step < 0 ? "Previous" : "Next") + "</small>" +
           other.label + "</a>";
  }

  [[nodiscard]] std::string filled(const std::string& page_template, std::size_t at) const {
    const Page& page = pages_[at];
    const auto headings = headings_of(page.html);
    std::string body = page.html;
    for (auto heading = headings.rbegin(); heading != headings.rend(); ++heading) {
      if (heading->anchor.empty() || heading->level == 1) continue;
      body.insert(heading->end - 5, " <a class=\"anchor\" href=\"#" + heading->anchor + "\" aria-label=\"link\">#</a>");
    }
    // Wide tables scroll by themselves.
    body = replaced(replaced(body, "<table", "<div class=\"table\"><table"), "</table>", "</table></div>");
    const std::string title = headings.empty() ? page.label : plain_markup(headings.front().html);
    const std::map<std::string, std::string, std::less<>> values{
        {"title", title == "lobe" ? title : title + " · lobe"},
        {"root", page.url.find('/') == page.url.npos ? "" : "../"},
        {"navigation", navigation(page)},
        {"group", groups_[page.group].title},
        {"contents", contents(headings)},
        {"body", body},
        {"previous", neighbour(at, -1)},
        {"next", neighbour(at, 1)}};
    std::string html;
    std::size_t from = 0;
    for (std::size_t begin = page_template.find('@'); begin != page_template.npos;
         begin = page_template.find('@', begin)) {
      const std::size_t end = page_template.find('@', begin + 1);
      const auto value = values.find(std::string_view(page_template).substr(begin + 1, end - begin - 1));
      if (value == values.end()) {
        ++begin;
        continue;
      }
      html += page_template.substr(from, begin - from) + value->second;
      from = begin = end + 1;
    }
    return html + page_template.substr(from);
  }

  /// A list of [url, page, heading, text], as a script: browsers do not read other files of a folder.
  [[nodiscard]] std::string search_index() const {
    std::string index = "const sections = [\n";
    for (const auto& page : pages_) {
      const auto headings = headings_of(page.html);
      const std::string title = headings.empty() ? page.label : plain(headings.front().html);
      for (std::size_t i = 0; i < headings.size(); ++i) {
        const std::size_t end = i + 1 < headings.size() ? headings[i + 1].begin : page.html.size();
        std::string text = plain(std::string_view(page.html).substr(headings[i].end, end - headings[i].end));
        const std::string anchor = headings[i].level == 1 || headings[i].anchor.empty() ? "" : "#" + headings[i].anchor;
        index += "[" + quoted(page.url + anchor) + "," + quoted(title) + "," + quoted(plain(headings[i].html)) + "," +
                 quoted(text) + "],\n";
      }
    }
    return index + "];\n";
  }

  [[nodiscard]] static std::string quoted(std::string_view text) {
    std::string result = "\"";
    for (const char c : text) {
      if (c == '"' || c == '\\') result += '\\';
      result += c;
    }
    return result + "\"";
  }

  struct Link {
    std::size_t page;
    std::string text;
    std::string url;
    std::string anchor;
  };

  fs::path repository_;
  fs::path fragments_;
  fs::path output_;
  std::vector<Group> groups_;
  std::vector<Page> pages_;
  std::map<std::string, std::size_t> place_of_;  ///< by source
  std::vector<Link> links_;
  std::vector<std::string> mistakes_;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::cerr << "usage: lobe_make_site REPOSITORY FRAGMENTS SITE\n";
    return 2;
  }
  try {
    Site site(argv[1], argv[2], argv[3]);
    site.make();
    for (const auto& mistake : site.mistakes()) std::cerr << mistake << "\n";
    if (!site.mistakes().empty()) return 1;
    std::cout << site.pages() << " pages\n";
  } catch (const std::exception& error) {
    std::cerr << "lobe_make_site: " << error.what() << "\n";
    return 3;
  }
  return 0;
}
