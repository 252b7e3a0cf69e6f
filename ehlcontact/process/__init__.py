"""Processes and threads: interruption, worker processes, compiling side by side, shared loops, memory.

=================== ================================================================================
module              responsibility
=================== ================================================================================
``early_interrupt`` Ctrl-C while the command line is being imported; imported before everything else
``worker``          worker process of an executor: tasks in, answers out, the end with its parent
``beside``          process that compiles beside this one, and ends with it
``threads``         `Team`: threads that share the loops of a solve; their default number
``blas``            limit of BLAS to one thread during a solve
``free_memory``     memory that is still available to this process
=================== ================================================================================
"""

from ehlcontact.process import early_interrupt as early_interrupt
