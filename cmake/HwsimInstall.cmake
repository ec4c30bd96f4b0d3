# Install rules are added with the first release layout.
