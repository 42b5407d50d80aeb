// `penumbra completion`: scripts for shells, made from the very options that the program declares. Names of
// techniques, scenes, configs and baselines are asked of the program when a key is pressed.
#include <fmt/format.h>

#include <map>
#include <memory>

#include "app/commands.h"
#include "core/error.h"

namespace penumbra {
namespace {

struct Command {
  std::string name, help;
  std::vector<std::string> options;  // --long
  std::string list;                  // what its first argument is: techniques, scenes, configs or nothing
  std::vector<std::string> words;    // what else may follow
};

std::vector<std::string> long_options(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

std::vector<Command> commands(CLI::App& app) {
  const std::map<std::string, std::string> lists = {
      {"run", "configs"}, {"validate", "configs"}, {"describe", "techniques"}, {"render", "scenes"}};
  std::vector<Command> out;
  for (CLI::App* sub : app.get_subcommands([](CLI::App* a) { return !a->get_group().empty(); })) {
    Command c{sub->get_name(), sub->get_description(), long_options(*sub), "", {}};
    for (const std::string& name : long_options(app)) c.options.push_back(name);
    if (const auto it = lists.find(c.name); it != lists.end()) c.list = it->second;
    for (const CLI::App* nested : sub->get_subcommands({})) c.words.push_back(nested->get_name());
    if (c.name == "list") c.words = {"techniques", "scenes", "configs", "devices"};
    if (c.name == "completion") c.words = {"bash", "zsh", "fish"};
    out.push_back(c);
  }
  return out;
}

// The script with its placeholders replaced.
std::string filled(std::string script, const std::map<std::string, std::string>& values) {
  for (const auto& [name, value] : values) {
    const std::size_t at = script.find(name);
    script.replace(at, name.size(), value);
  }
  return script;
}

std::string bash(const std::vector<Command>& all) {
  std::string names, cases;
  for (const Command& c : all) {
    names += c.name + " ";
    cases += fmt::format("    {}) options='{}'; words='{}'; list='{}' ;;\n", c.name,
                         fmt::join(c.options, " "), fmt::join(c.words, " "), c.list);
  }
  constexpr const char* script =
      R"sh(# bash completion of penumbra; in ~/.bashrc: eval "$(penumbra completion bash)"
_penumbra() {
  local current=${COMP_WORDS[COMP_CWORD]} command='' word options='' words='' list=''
  for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
    case $word in -*) ;; *) command=$word; break ;; esac
  done
  COMPREPLY=()
  case $command in
@CASES@    *) words='@NAMES@' ;;
  esac
  if [[ $current == -* ]]; then
    COMPREPLY=($(compgen -W "$options" -- "$current"))
    return
  fi
  [ -n "$list" ] && words="$words $("${COMP_WORDS[0]}" list "$list" 2>/dev/null | cut -d' ' -f1)"
  COMPREPLY=($(compgen -W "$words" -- "$current"))
}
complete -o default -F _penumbra penumbra
)sh";
  return filled(script, {{"@CASES@", cases}, {"@NAMES@", names}});
}

// Text between single quotes of a shell.
std::string in_quotes(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out;
}

std::string zsh(const std::vector<Command>& all) {
  std::string descriptions, cases;
  for (const Command& c : all) {
    std::string help = c.help;
    std::erase(help, ':');
    descriptions += fmt::format("    '{}:{}'\n", c.name, in_quotes(help));
    cases += fmt::format("    {}) options=({}); candidates=({}); list='{}' ;;\n", c.name,
                         fmt::join(c.options, " "), fmt::join(c.words, " "), c.list);
  }
  constexpr const char* script = R"sh(#compdef penumbra
# zsh completion of penumbra; a file _penumbra in a folder of $fpath, or: eval "$(penumbra completion zsh)"
_penumbra() {
  local -a commands options candidates
  local list=''
  commands=(
@DESCRIPTIONS@  )
  if (( CURRENT == 2 )); then
    _describe command commands
    return
  fi
  case $words[2] in
@CASES@  esac
  if [[ $words[CURRENT] == -* ]]; then
    compadd -- $options
    return
  fi
  [[ -n $list ]] && candidates+=(${(f)"$(penumbra list $list 2>/dev/null | cut -d' ' -f1)"})
  compadd -- $candidates
  _files
}
# A file of $fpath is read when it is first needed, and then has to answer at once.
if [[ $zsh_eval_context[-1] == loadautofunc ]]; then _penumbra "$@"; else compdef _penumbra penumbra; fi
)sh";
  return filled(script, {{"@DESCRIPTIONS@", descriptions}, {"@CASES@", cases}});
}

std::string fish(const std::vector<Command>& all) {
  std::string text =
      "# fish completion of penumbra: penumbra completion fish > ~/.config/fish/completions/penumbra.fish\n";
  for (const Command& c : all) {
    text += fmt::format("complete -c penumbra -n __fish_use_subcommand -a {} -d '{}'\n", c.name,
                        in_quotes(c.help));
    const std::string when = fmt::format("complete -c penumbra -n '__fish_seen_subcommand_from {}'", c.name);
    for (const std::string& option : c.options) text += fmt::format("{} -l {}\n", when, option.substr(2));
    if (!c.words.empty()) text += fmt::format("{} -a '{}'\n", when, fmt::join(c.words, " "));
    if (!c.list.empty())
      text += fmt::format("{} -a '(penumbra list {} 2>/dev/null | cut -d\" \" -f1)'\n", when, c.list);
  }
  return text;
}

}  // namespace

void add_completion(CLI::App& app, Context&) {
  auto shell = std::make_shared<std::string>();
  CLI::App* sub = app.add_subcommand("completion", "Print a completion script for a shell");
  sub->add_option("SHELL", *shell, "bash|zsh|fish")->required();
  sub->callback([shell, &app] {
    const std::vector<Command> all = commands(app);
    const std::vector<std::string> shells{"bash", "zsh", "fish"};
    if (*shell == "bash")
      fmt::print("{}", bash(all));
    else if (*shell == "zsh")
      fmt::print("{}", zsh(all));
    else if (*shell == "fish")
      fmt::print("{}", fish(all));
    else
      throw InputError(
          fmt::format("completion: found '{}', expected a shell.{}", *shell, suggestion(*shell, shells)));
  });
}

}  // namespace penumbra
