"""The notation of the paper; nothing here says what a symbol means.

What a symbol means differs from section to section, and that is what is checked: each claim says it
for itself.  E*, phi, f, R and the place x are ours from the start.
"""

from sympy import Symbol, symbols

from derive.paper.bodies import parameter_of

phi = parameter_of("wedge", "phi")
R = parameter_of("hertz", "R")

a, c, h, p, q, P, M, Q = symbols("a c h p q P M Q")
a_1, a_2, d, d_1, d_2, m, n = symbols("a_1 a_2 d d_1 d_2 m n")
alpha, alpha_0, alpha_1, alpha_2 = symbols("alpha alpha_0 alpha_1 alpha_2")
gamma, gamma_t = symbols("gamma gamma_t")
sigma, Delta_sigma, Delta_sigma_th = symbols("sigma Delta_sigma Delta_sigma_th")
Delta_Q, Delta_a, Delta_q, Delta_K_T = symbols("Delta_Q Delta_a Delta_q Delta_K_T")
dQ, dP, dM, dsigma = symbols("dQ dP dM dsigma")
K_N, K_T, K_Nc, K_Na = symbols("K_N K_T K_N_c K_N_a")
K_N1, K_N2, K_Q1, K_Q2 = symbols("K_N1 K_N2 K_Q1 K_Q2")
K_LHS, K_RHS = symbols("K_N_LHS K_N_RHS")
d_LHS, d_RHS = symbols("d_LHS d_RHS")
x_1 = Symbol("x_1")
d_i, Q_1, Q_2, Q_i = symbols("d_i Q_1 Q_2 Q_i")
P_0, P_S, P_Z = symbols("P_0 P_S P_Z")
q_1, q_2, p_S, p_Z = symbols("q_1 q_2 p_S p_Z")
dp_dP, dP_dQ = symbols("dp_dP dP_dQ")
F, g_prime, P_prime, a_prime = symbols("F g_prime P_prime a_prime")
E, nu, p_0, e = symbols("E nu p_0 e")
s, xi = symbols("s xi", real=True)
"""Variables of integration."""
