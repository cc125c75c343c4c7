# deb822 stanzas (RS="") of the distribution's own suites, as source-package stanzas.
# `codename` is the release's name. Continued lines belong to the field above them.
function join(a, b) {
  sub(/^[ \t]+/, "", b)
  return a == "" ? b : a " " b
}
{
  types = ""; suites = ""; components = ""; uris = ""; rest = ""; field = ""; on = 1
  n = split($0, line, "\n")
  for (i = 1; i <= n; i++) {
    if (line[i] ~ /^#/) continue
    if (line[i] ~ /^[ \t]/) {
      value = line[i]
    } else {
      field = tolower(line[i]); sub(/:.*/, "", field)
      value = line[i]; sub(/^[^:]*:[ \t]*/, "", value)
    }
    if (field == "types") types = join(types, value)
    else if (field == "suites") suites = join(suites, value)
    else if (field == "components") components = join(components, value)
    else if (field == "uris") uris = join(uris, value)
    else if (field == "enabled") on = (value !~ /no|false|off|0/)
    else rest = rest line[i] "\n"
  }
  wanted = ""
  n = split(suites, suite, /[ \t]+/)
  for (i = 1; i <= n; i++)
    if (suite[i] ~ ("^(" codename "|stable|testing|sid)(-updates|-security)?/?$"))
      wanted = join(wanted, suite[i])
  if (!on || wanted == "" || (" " types " ") !~ / deb / || uris ~ /cdrom:/) next
  if ((" " components " ") !~ / (main|universe) /) next
  printf "Types: deb-src\nURIs: %s\nSuites: %s\nComponents: %s\n%s\n", uris, wanted, components, rest
}
