# Prints what zsh offers when Tab is pressed behind a line: zsh -f offered.zsh FOLDER LINE, with FOLDER/_palpate. Completion
# needs a terminal: the line is typed into a shell at one of its own, which writes down all that is added to the list.
zmodload zsh/zpty
found=$1/offered
: > $found
cat > $1/.zshrc <<'RC'
fpath=($ZDOTDIR $fpath)
autoload -Uz compinit
compinit -D -u
LISTMAX=10000
compadd() {
  local -a words
  # With -O, -A or -D, nothing is added.
  if [[ -z ${(M)@:#-[OAD]*} ]]; then
    builtin compadd -O words "$@"
    print -rl -- $words >> $ZDOTDIR/offered
  fi
  builtin compadd "$@"
}
PROMPT=ready
RC
export ZDOTDIR=$1
zpty shell zsh -d -i
zpty -r shell output '*ready*'
zpty -w -n shell "$2"$'\t\x15'$'exit\n'
while zpty -r shell output; do :; done
sort -u $found
