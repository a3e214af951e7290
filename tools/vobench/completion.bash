# Completion of vobench for bash: commands and options as its own --help lists them, else files.
_vobench() {
  local word=${COMP_WORDS[COMP_CWORD]} command=()
  COMPREPLY=()
  ((COMP_CWORD > 1)) && command=("${COMP_WORDS[1]}")
  if ((COMP_CWORD == 1)) || [[ $word == -* ]]; then
    COMPREPLY=($(compgen -W "$("${COMP_WORDS[0]}" "${command[@]}" --help 2>/dev/null |
      sed -nE 's/^  (-[a-z], )?([a-z-]+) .*/\1\2/p' | tr -d ,)" -- "$word"))
  else
    compopt -o default 2>/dev/null
  fi
}
complete -F _vobench vobench
