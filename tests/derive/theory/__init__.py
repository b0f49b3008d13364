"""The mechanics, each stage against integrals done here by quadrature."""
