"""The command `derive`: its arguments, its output, and what it needs of files and processes.

module        contents
------------  ----------------------------------------------------------------
errors        what users can get wrong, one class for each kind
limit         a time limit for a search
processes     work in separate processes, with limits on time and memory
files         files that are read up to a limit and written whole
folder        a directory that is replaced as a whole, with the list of its files
new_geometry  a new geometry from g(x) given as text, made in a process with limits
terminal      text, tables and progress bars
view          tables and formula sheets for a terminal
showing       what is made of bodies for `derive show` and `generate`
checking      what `derive check` does before it judges claims
options       types of options and arguments
group         how a command begins and ends
cli           the commands
"""
