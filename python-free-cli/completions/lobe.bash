# Completion of lobe in bash. What may follow, the command itself knows: lobe __complete WORD...

_lobe() {
  # Words as they were typed: bash parts them at ':', '=' and '@', too.
  local -a words=()
  local i part blank rest=${COMP_LINE:0:COMP_POINT}
  for ((i = 0; i <= COMP_CWORD; ++i)); do
    blank=${rest%%[![:blank:]]*}
    rest=${rest#"$blank"}
    part=${COMP_WORDS[i]}
    ((i < COMP_CWORD)) || part=$rest
    rest=${rest#"$part"}
    if ((i == 0)) || [ -n "$blank" ]; then
      words+=("$part")
    else
      words[-1]+=$part
    fi
  done

  # Bash replaces what follows the last character at which it parts words, unless a quote is open.
  local word=${words[-1]} done=''
  case $word in
    [\'\"]*) word=${word:1} ;;
    *) done=${word%"${word##*["$COMP_WORDBREAKS"]}"} ;;
  esac
  words[-1]=$word

  local candidate help paths='' ending=''
  COMPREPLY=()
  while IFS=$'\t' read -r candidate help; do
    if [ -z "$paths" ]; then
      paths=$candidate
      ending=$help
      continue
    fi
    case $candidate in
      *[:=]) compopt -o nospace 2>/dev/null ;;
    esac
    COMPREPLY+=("${candidate#"$done"}")
  done < <("${words[0]}" __complete "${words[@]:1}" 2>/dev/null)

  local path name=${word#"$done"}
  case $paths in
    files)
      compopt -o filenames 2>/dev/null
      while IFS= read -r path; do
        if [ -d "${path/#\~/$HOME}" ] || [[ $path == *"$ending" ]]; then
          COMPREPLY+=("$path")
        fi
      done < <(compgen -f -- "$name")
      ;;
    directories)
      compopt -o filenames 2>/dev/null
      while IFS= read -r path; do
        COMPREPLY+=("$path")
      done < <(compgen -d -- "$name")
      ;;
  esac
}

complete -F _lobe lobe
