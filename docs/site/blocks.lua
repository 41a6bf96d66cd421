-- For pandoc: in a block ```console what is typed looks different from what is printed.

local function escaped(text)
  return (text:gsub("&", "&amp;"):gsub("<", "&lt;"):gsub(">", "&gt;"))
end

function CodeBlock(block)
  if block.classes[1] ~= "console" then return nil end
  local lines = {}
  for line in (block.text .. "\n"):gmatch("(.-)\n") do
    local typed = line:match("^%$ (.*)")
    lines[#lines + 1] = typed and '<span class="prompt">$ </span><b>' .. escaped(typed) .. "</b>" or escaped(line)
  end
  return pandoc.RawBlock("html", '<pre class="console"><code>' .. table.concat(lines, "\n") .. "</code></pre>")
end
