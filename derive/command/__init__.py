"""The command `derive`: its arguments, its output, and what it needs of files and processes.

module          contents
-------------   ----------------------------------------------------------------
errors          what users can get wrong, one class for each kind
limit           a time limit for a search
processes       work in separate processes, with limits on time and memory
files           files that are read up to a limit and written whole
manifest        the list of the files in a directory that a command wrote
folder          a directory that is replaced as a whole
shelf           pages that are written as a whole
cache           built bodies that are kept
python_of       g(x) as exact Python code
name_values     options of the form NAME=TEXT
target          a new file
new_geometry    a geometry file from g(x) given as text
new_in_process  the same in a process with limits
terminal        text, tables and progress bars
view            tables and formula sheets for a terminal
showing         what `derive show` prints and writes
cli             the commands
"""
